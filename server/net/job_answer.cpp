#include "server/net/job_answer.hpp"

#include "server/http/problem.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <cstdio>
#include <poll.h>

namespace stipple::server {

namespace {

namespace net = boost::asio;
constexpr auto answered = net::as_tuple(net::use_awaitable);
constexpr std::size_t pieceBytes = 256 * 1024; // for each of which the limit on progress holds

HttpResponse retryLater(HttpResponse problem, const char* seconds) {
    problem.set("Retry-After", seconds);
    return problem;
}

HttpResponse serverIsBusy() {
    return retryLater(problemResponse(503, "the server has too much to do"), "5");
}

std::size_t allAtOnce(const boost::system::error_code& error, std::size_t) {
    return error ? 0 : 2 * pieceBytes;
}

} // namespace

JobAnswer::JobAnswer(Loop& loop, net::ip::tcp::socket& socket, std::string client, Job job, bool headOnly)
    : loop_(loop), socket_(socket), client_(std::move(client)),
      wake_(std::make_shared<net::steady_timer>(loop.context())), headOnly_(headOnly) {
    auto onNews = [wake = wake_, &context = loop.context()] {
        net::post(context, [wake] { wake->cancel(); });
    };
    run_ = std::make_shared<JobRun>(std::move(job), headOnly, std::move(onNews));
}

JobAnswer::~JobAnswer() {
    if (!isSubmitted_ || news_.isOver)
        return;
    if (news_.isWhole || (isStreamed_ && headOnly_))
        run_->stop(); // all is said; it is about to end
    else
        loop_.state().jobs.withdraw(run_);
}

std::optional<HttpResponse> JobAnswer::refusal(JobPool::Admission admission) const {
    if (admission == JobPool::Admission::clientIsBusy)
        return retryLater(problemResponse({problem_types::tooManyRequests,
                                           cat("no more than ", loop_.state().jobs.limits().perClient,
                                               " such requests at once")}),
                          "1");
    if (admission == JobPool::Admission::isFull)
        return serverIsBusy();
    return std::nullopt;
}

net::awaitable<std::optional<HttpResponse>> JobAnswer::wait() {
    submitted_ = std::chrono::steady_clock::now();
    auto refused = refusal(loop_.state().jobs.submit(client_, run_));
    if (refused)
        co_return refused;
    isSubmitted_ = true;
    for (;;) {
        co_await nextNews();
        if (news_.head) {
            isStreamed_ = !news_.isWhole;
            co_return std::move(news_.head);
        }
        if (news_.isOver)
            co_return jobProblem(news_.failure ? *news_.failure
                                               : Error{ErrorCode::ioFailed, "there is no answer", "", ""});
        if (!hasClient())
            co_return std::nullopt;
        if (isOverTime())
            co_return overTimeProblem();
    }
}

// Of waiting for its turn, or of working.
bool JobAnswer::isOverTime() const {
    auto now = std::chrono::steady_clock::now();
    const JobLimits& limits = loop_.state().jobs.limits();
    auto worked = run_->worked(now);
    return worked ? *worked >= limits.work : now - submitted_ >= limits.queue;
}

HttpResponse JobAnswer::overTimeProblem() const {
    if (!run_->worked(std::chrono::steady_clock::now()))
        return serverIsBusy();
    auto seconds = std::chrono::duration<double>(loop_.state().jobs.limits().work).count();
    return problemResponse({problem_types::outOfTime, cat("this takes longer than ", seconds, " seconds")});
}

bool JobAnswer::hasClient() const {
    if (!socket_.is_open())
        return false;
    struct pollfd state {
        socket_.native_handle(), POLLRDHUP, 0
    };
    return ::poll(&state, 1, 0) <= 0;
}

// What there is; if nothing, what there is after a glance's time or as soon as the job says so.
net::awaitable<void> JobAnswer::nextNews() {
    news_ = run_->take(body_);
    if (news_.head || !body_.empty() || news_.isOver)
        co_return;
    wake_->expires_after(glance);
    co_await wake_->async_wait(answered);
    news_ = run_->take(body_);
}

net::awaitable<SendOutcome> JobAnswer::sendBody(std::string head, BodyFraming framing,
                                                std::function<void()> onProgress) {
    head_ = std::move(head);
    framing_ = framing;
    for (;;) { // the bytes that came with the head are in body_ already
        bool isLast = news_.isOver && !news_.failure;
        std::string_view rest = body_;
        while (!rest.empty() || !head_.empty() || isLast) {
            std::string_view piece = rest.substr(0, pieceBytes);
            rest.remove_prefix(piece.size());
            onProgress();
            bool isSent = co_await sendPiece(piece, isLast && rest.empty());
            if (!isSent)
                co_return outcome_;
            if (rest.empty())
                break;
        }
        outcome_.isComplete = isLast;
        if (news_.isOver)
            co_return outcome_;
        onProgress(); // a job that computes is no client that does not read
        co_await nextNews();
        if (!news_.isOver && (!hasClient() || isOverTime()))
            co_return outcome_;
    }
}

// Head, chunk size, bytes and the end of the chunk, in one call. The last chunk is empty (RFC 9112 §7.1).
net::awaitable<bool> JobAnswer::sendPiece(std::string_view piece, bool isLast) {
    char before[24] = "";
    std::string_view after;
    if (framing_ == BodyFraming::chunked) {
        if (!piece.empty()) {
            std::snprintf(before, sizeof before, "%zx\r\n", piece.size());
            after = isLast ? "\r\n0\r\n\r\n" : "\r\n";
        } else if (isLast) {
            after = "0\r\n\r\n";
        }
    }
    std::string_view beforeView(before);
    std::array<net::const_buffer, 4> buffers{net::buffer(head_), net::buffer(beforeView), net::buffer(piece),
                                             net::buffer(after)};
    std::size_t headBytes = head_.size() + beforeView.size();
    auto [error, written] = co_await net::async_write(socket_, buffers, allAtOnce, answered);
    outcome_.bodyBytes += std::min(written > headBytes ? written - headBytes : 0, piece.size());
    head_.clear();
    co_return !error;
}

} // namespace stipple::server
