// Work that several threads do, whose results one thread takes in the order in which it asked for them.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace stipple {

// submit() and take() belong to one thread, which does work too while it waits in take(). The caller bounds
// how much waits: waiting() counts what was submitted and not yet taken. Work not taken by the end is dropped
// once the piece in hand is done. Work may not throw.
template <class Out>
class OrderedWork {
  public:
    explicit OrderedWork(int threads) {
        for (int i = 1; i < threads; ++i)
            helpers_.emplace_back([this] { help(); });
    }
    ~OrderedWork() {
        {
            std::lock_guard lock(mutex_);
            stopped_ = true;
        }
        changed_.notify_all();
        for (std::thread& helper : helpers_)
            helper.join();
    }
    OrderedWork(const OrderedWork&) = delete;
    OrderedWork& operator=(const OrderedWork&) = delete;

    void submit(std::function<Out()> work) {
        auto piece = std::make_shared<Piece>();
        piece->work = std::move(work);
        {
            std::lock_guard lock(mutex_);
            taken_.push_back(piece);
            open_.push_back(std::move(piece));
        }
        changed_.notify_all();
    }

    std::size_t waiting() const { return taken_.size(); } // only the owner alters it

    // The result of the oldest piece; there must be one.
    Out take() {
        std::unique_lock lock(mutex_);
        std::shared_ptr<Piece> piece = taken_.front();
        while (!piece->result) {
            if (!open_.empty())
                runOne(lock);
            else
                changed_.wait(lock);
        }
        taken_.pop_front();
        return std::move(*piece->result);
    }

  private:
    struct Piece {
        std::function<Out()> work;
        std::optional<Out> result;
    };

    void runOne(std::unique_lock<std::mutex>& lock) {
        std::shared_ptr<Piece> piece = std::move(open_.front());
        open_.pop_front();
        lock.unlock();
        std::optional<Out> result(piece->work());
        piece->work = nullptr; // with what it holds
        lock.lock();
        piece->result = std::move(result);
        changed_.notify_all();
    }

    void help() {
        std::unique_lock lock(mutex_);
        while (!stopped_) {
            if (!open_.empty())
                runOne(lock);
            else
                changed_.wait(lock);
        }
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::shared_ptr<Piece>> taken_, open_; // in order; those not begun
    bool stopped_ = false;
    std::vector<std::thread> helpers_;
};

} // namespace stipple
