#include "server/jobs/job_run.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <exception>

namespace stipple::server {

namespace {

Error cancelledError() {
    return {ErrorCode::cancelled, "nobody waits for the answer any more", "", ""};
}

// Libraries may throw (memory, above all); one job's trouble must not end the server.
Status runCatching(const std::function<Status(AnswerWriter&)>& work, AnswerWriter& writer) {
    try {
        return work(writer);
    } catch (const std::exception& problem) {
        return Error{ErrorCode::ioFailed, cat("the work broke off: ", problem.what()), "", ""};
    }
}

} // namespace

JobRun::JobRun(Job job, bool headOnly, std::function<void()> onNews)
    : job_(std::move(job)), headOnly_(headOnly), onNews_(std::move(onNews)) {}

void JobRun::run(std::function<void(bool)> onWaiting) {
    {
        std::lock_guard lock(mutex_);
        onWaiting_ = std::move(onWaiting);
        began_ = Clock::now();
    }
    Status status = stopped_ ? Status(cancelledError()) : runCatching(job_.run, *this);
    job_.run = nullptr; // files that it holds are closed on this thread, not the connection's
    std::unique_lock lock(mutex_);
    isEnded_ = true;
    if (!status)
        failure_ = status.error();
    tell(lock);
}

void JobRun::answer(HttpResponse response) {
    std::unique_lock lock(mutex_);
    if (isAnswered_)
        return;
    isAnswered_ = isWhole_ = true;
    head_ = std::move(response);
    tell(lock);
}

Status JobRun::begin(HttpResponse head) {
    std::unique_lock lock(mutex_);
    if (isAnswered_)
        return Error{ErrorCode::invalidArgument, "the answer has begun already", "", ""};
    if (stopped_)
        return cancelledError();
    isAnswered_ = true;
    head_ = std::move(head);
    if (!headOnly_)
        return {}; // leaves with the first bytes
    stopped_ = true;
    tell(lock);
    return cancelledError();
}

void JobRun::handOver(Job next) {
    std::lock_guard lock(mutex_);
    if (!isAnswered_)
        next_ = std::move(next);
}

Status JobRun::write(ByteSpan bytes) {
    while (!bytes.empty()) {
        std::unique_lock lock(mutex_);
        if (!isAnswered_ || isWhole_)
            return Error{ErrorCode::invalidArgument, "the answer has not begun", "", ""};
        if (!waitForRoom(lock))
            return cancelledError();
        std::size_t count = std::min(bytes.size(), waitingBytes - pending_.size());
        pending_.append(reinterpret_cast<const char*>(bytes.data()), count);
        bytes = bytes.subspan(count);
        bool isFirst = !hasWritten_;
        hasWritten_ = true;
        if (isFirst || pending_.size() >= worthSendingBytes)
            tell(lock);
    }
    return {};
}

bool JobRun::waitForRoom(std::unique_lock<std::mutex>& lock) {
    if (pending_.size() < waitingBytes || stopped_)
        return !stopped_;
    waitsSince_ = Clock::now();
    lock.unlock(); // the pool has a lock of its own
    onWaiting_(true);
    lock.lock();
    room_.wait(lock, [this] { return pending_.size() < waitingBytes || stopped_; });
    waited_ += Clock::now() - *waitsSince_;
    waitsSince_.reset();
    lock.unlock();
    onWaiting_(false);
    lock.lock();
    return !stopped_;
}

void JobRun::tell(std::unique_lock<std::mutex>& lock) {
    bool isAwaited = wantsNews_;
    wantsNews_ = false;
    lock.unlock();
    if (isAwaited)
        onNews_();
}

void JobRun::stop() {
    std::lock_guard lock(mutex_);
    stopped_ = true;
    room_.notify_all();
}

std::optional<std::chrono::milliseconds> JobRun::worked(Clock::time_point now) const {
    std::lock_guard lock(mutex_);
    if (!began_)
        return std::nullopt;
    Clock::time_point until = waitsSince_ ? *waitsSince_ : now;
    return std::chrono::duration_cast<std::chrono::milliseconds>(until - *began_ - waited_);
}

JobNews JobRun::take(std::string& body, std::size_t least) {
    body.clear();
    std::lock_guard lock(mutex_);
    JobNews news;
    news.head = std::move(head_);
    head_.reset();
    news.isWhole = isWhole_;
    if (pending_.size() >= least || !hasTaken_ || isEnded_) {
        std::swap(body, pending_);
        hasTaken_ = hasTaken_ || !body.empty();
        room_.notify_all();
    }
    if (isEnded_) {
        news.isOver = true;
        news.failure = failure_;
        news.next = std::move(next_);
        next_.reset();
    }
    wantsNews_ = !news.head && body.empty() && !news.isOver;
    return news;
}

} // namespace stipple::server
