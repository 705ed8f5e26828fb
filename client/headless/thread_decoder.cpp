#include "client/headless/thread_decoder.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

namespace stipple {

namespace {

class ThreadDecoder final : public NodeDecoder {
  public:
    explicit ThreadDecoder(int threads) {
        unsigned cores = std::max(1u, std::thread::hardware_concurrency());
        int count = threads > 0 ? threads : static_cast<int>(cores);
        for (int i = 0; i < count; ++i)
            workers_.emplace_back([this] { work(); });
    }

    ~ThreadDecoder() override {
        {
            std::lock_guard lock(mutex_);
            stopping_ = true;
            isClosed_ = true;
        }
        jobArrived_.notify_all();
        for (std::thread& worker : workers_)
            worker.join();
        while (!open_.empty()) {
            Completion done = takeCompletion(open_.begin()->first);
            done(Error{ErrorCode::cancelled, "the decoder was closed", "", ""});
        }
    }

    void decode(DecodeJob job, Completion done) override {
        std::uint64_t number = ++last_;
        open_.emplace(number, std::move(done));
        {
            std::lock_guard lock(mutex_);
            jobs_.push_back({number, std::move(job)});
        }
        jobArrived_.notify_one();
    }

    int pump(std::chrono::milliseconds wait) override {
        std::deque<Answer> ready;
        {
            std::unique_lock lock(mutex_);
            if (wait.count() > 0 && !open_.empty())
                answerReady_.wait_for(lock, wait, [this] { return !answers_.empty(); });
            ready.swap(answers_);
        }
        for (Answer& answer : ready)
            takeCompletion(answer.number)(std::move(answer.node)); // may call decode()
        return static_cast<int>(ready.size());
    }

    std::size_t pending() const override { return open_.size(); }

  private:
    struct Job {
        std::uint64_t number;
        DecodeJob job;
    };
    struct Answer {
        std::uint64_t number;
        Result<ResidentNode> node;
    };

    void work() {
        std::unique_lock lock(mutex_);
        while (true) {
            jobArrived_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
            if (stopping_)
                return;
            Job job = std::move(jobs_.front());
            jobs_.pop_front();
            lock.unlock();
            Result<ResidentNode> node = decodeNode(job.job, &gate_);
            lock.lock();
            answers_.push_back({job.number, std::move(node)});
            answerReady_.notify_one();
        }
    }

    Completion takeCompletion(std::uint64_t number) {
        auto at = open_.find(number);
        Completion done = std::move(at->second);
        open_.erase(at);
        return done;
    }

    // Of the owner's thread.
    std::map<std::uint64_t, Completion> open_;
    std::uint64_t last_ = 0;

    std::mutex mutex_; // guards what follows
    std::condition_variable jobArrived_, answerReady_;
    std::deque<Job> jobs_;
    std::deque<Answer> answers_;
    bool stopping_ = false;

    std::atomic<bool> isClosed_{false}; // ends the jobs that have begun
    const StopGate gate_{&isClosed_};
    std::vector<std::thread> workers_;
};

} // namespace

std::unique_ptr<NodeDecoder> makeThreadDecoder(int threads) {
    return std::make_unique<ThreadDecoder>(threads);
}

} // namespace stipple
