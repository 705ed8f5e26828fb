// One job between its two threads: the job's, which makes the answer, and the connection's, which sends it.
// What waits in between is bounded: a job that is faster than its client is held back in write().
#pragma once

#include "server/http/job.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

namespace stipple::server {

// What the connection finds when it looks.
struct JobNews {
    std::optional<HttpResponse> head; // once
    bool isWhole = false;             // with `head`: the whole answer, with its body; nothing follows
    bool isOver = false;              // the job has ended, and all its bytes have been taken
    std::optional<Error> failure;     // with `isOver`
    std::optional<Job> next;          // with `isOver`: answers instead
};

class JobRun final : public AnswerWriter {
  public:
    using Clock = std::chrono::steady_clock;
    // Of these, one is being made while another is being sent, so a run holds twice as much.
    static constexpr std::size_t waitingBytes = 512 * 1024;
    // Less than this does not wake the connection, which looks by itself every now and then.
    static constexpr std::size_t worthSendingBytes = 16 * 1024;

    // `headOnly`: the answer to a HEAD; begin() ends the job. `onNews` is called from the job's thread when
    // take() found nothing before and would now.
    JobRun(Job job, bool headOnly, std::function<void()> onNews);

    // ---- The job's thread.
    // `onWaiting(true)` when the job begins to wait for its client, `onWaiting(false)` when it goes on.
    void run(std::function<void(bool waits)> onWaiting);
    void answer(HttpResponse response) override;
    Status begin(HttpResponse head) override;
    Status write(ByteSpan bytes) override;
    const std::atomic<bool>& isStopped() const override { return stopped_; }
    void handOver(Job next) override;

    // ---- Any thread.
    void stop(); // nobody takes the answer any more
    // Time that the job has worked; what it waited for its client is not counted. Nothing before run().
    std::optional<std::chrono::milliseconds> worked(Clock::time_point now) const;
    const std::string& kind() const { return job_.kind; }
    bool isTransfer() const { return job_.isTransfer; }

    // ---- The connection's thread. The bytes of the body that are there go to `body`, whose old content is
    // dropped and whose memory is used again. Fewer than `least` are left there, unless they are the first or
    // the last.
    JobNews take(std::string& body, std::size_t least = 1);

  private:
    bool waitForRoom(std::unique_lock<std::mutex>& lock);
    void tell(std::unique_lock<std::mutex>& lock); // unlocks

    Job job_;
    const bool headOnly_;
    const std::function<void()> onNews_;
    std::function<void(bool)> onWaiting_;
    std::atomic<bool> stopped_{false};

    mutable std::mutex mutex_;
    std::condition_variable room_;
    std::optional<HttpResponse> head_;
    bool isAnswered_ = false, isWhole_ = false, isEnded_ = false;
    bool wantsNews_ = false, hasWritten_ = false, hasTaken_ = false;
    std::optional<Error> failure_;
    std::optional<Job> next_;
    std::string pending_; // at most waitingBytes
    std::optional<Clock::time_point> began_, waitsSince_;
    Clock::duration waited_{};
};

} // namespace stipple::server
