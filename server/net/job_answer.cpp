#include "server/net/job_answer.hpp"

#include "server/http/problem.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <cstdio>

namespace stipple::server {

namespace {

constexpr std::size_t pieceBytes = 256 * 1024; // for each of which the limit on progress holds

HttpResponse retryLater(HttpResponse problem, std::string seconds) {
    problem.set("Retry-After", std::move(seconds));
    return problem;
}

HttpResponse serverIsBusy() {
    return retryLater(problemResponse(503, "the server has too much to do"), "5");
}

} // namespace

JobAnswer::JobAnswer(Loop& loop, Stream& stream, std::string client, Job job, bool headOnly)
    : loop_(loop), stream_(stream), client_(std::move(client)),
      wake_(std::make_shared<Timer>(loop.context())), headOnly_(headOnly) {
    prepare(std::move(job));
}

void JobAnswer::prepare(Job job) {
    rate_ = job.rate;
    auto onNews = [wake = wake_, &context = loop_.context()] {
        net::post(context, [wake] { wake->cancel(); });
    };
    run_ = std::make_shared<JobRun>(std::move(job), headOnly_, std::move(onNews));
}

BodyFraming JobAnswer::framing(const HttpResponse& head, int version) const {
    if (!head.body.empty())
        return BodyFraming::length;
    return version == 11 ? BodyFraming::chunked : BodyFraming::untilClose;
}

JobAnswer::~JobAnswer() {
    if (!isSubmitted_ || news_.isOver)
        return;
    if (news_.isWhole || (isStreamed_ && headOnly_))
        run_->stop(); // all is said; it is about to end
    else
        pool().withdraw(run_);
}

std::optional<HttpResponse> JobAnswer::rateRefusal() const {
    if (!rate_)
        return std::nullopt;
    auto wait = rate_->take(client_, std::chrono::steady_clock::now());
    if (wait.count() == 0)
        return std::nullopt;
    return retryLater(problemResponse({problem_types::tooManyRequests,
                                       cat("no more than ", rate_->perMinute(), " such requests a minute")}),
                      std::to_string(wait.count()));
}

std::optional<HttpResponse> JobAnswer::refusal(JobPool::Admission admission) const {
    if (admission == JobPool::Admission::clientIsBusy)
        return retryLater(
            problemResponse({problem_types::tooManyRequests,
                             cat("no more than ", pool().limits().perClient, " such requests at once")}),
            "1");
    if (admission == JobPool::Admission::isFull)
        return serverIsBusy();
    return std::nullopt;
}

// Of the run that is next; a refusal if it can't be.
std::optional<HttpResponse> JobAnswer::submit() {
    if (auto tooOften = rateRefusal())
        return tooOften;
    submitted_ = std::chrono::steady_clock::now();
    news_ = {};
    auto admission = pool().submit(client_, run_);
    isSubmitted_ = admission == JobPool::Admission::accepted;
    return refusal(admission);
}

Task<std::optional<HttpResponse>> JobAnswer::wait() {
    auto refused = submit();
    if (refused)
        co_return refused;
    for (;;) {
        co_await nextNews();
        if (news_.next) {
            prepare(std::move(*news_.next));
            refused = submit();
            if (refused)
                co_return refused;
            continue;
        }
        if (news_.head) {
            isStreamed_ = !news_.isWhole;
            co_return std::move(news_.head);
        }
        if (news_.isOver)
            co_return jobProblem(news_.failure ? *news_.failure
                                               : Error{ErrorCode::ioFailed, "there is no answer", "", ""});
        if (stream_.hasClientLeft())
            co_return std::nullopt;
        if (isOverTime())
            co_return overTimeProblem();
    }
}

// Of waiting for its turn, or of working.
bool JobAnswer::isOverTime() const {
    auto now = std::chrono::steady_clock::now();
    const JobLimits& limits = pool().limits();
    auto worked = run_->worked(now);
    return worked ? *worked >= limits.work : now - submitted_ >= limits.queue;
}

HttpResponse JobAnswer::overTimeProblem() const {
    if (!run_->worked(std::chrono::steady_clock::now()))
        return serverIsBusy();
    auto seconds = std::chrono::duration<double>(pool().limits().work).count();
    return problemResponse({problem_types::outOfTime, cat("this takes longer than ", seconds, " seconds")});
}

// What there is, if it is worth sending; else what there is after a glance's time or as soon as the job says
// so.
Task<void> JobAnswer::nextNews() {
    news_ = run_->take(body_, JobRun::worthSendingBytes);
    if (news_.head || !body_.empty() || news_.isOver)
        co_return;
    wake_->expires_after(glance);
    co_await wake_->async_wait(answered);
    news_ = run_->take(body_);
}

Task<SendOutcome> JobAnswer::sendBody(std::string_view head, BodyFraming framing,
                                      std::function<void()> onProgress) {
    framing_ = framing;
    out_ = head;
    for (;;) { // the bytes that came with the head are in body_ already
        bool isLast = news_.isOver && !news_.failure;
        std::string_view rest = body_;
        while (!rest.empty() || !out_.empty() || isLast) {
            std::string_view piece = rest.substr(0, pieceBytes);
            rest.remove_prefix(piece.size());
            appendPiece(piece, isLast && rest.empty());
            onProgress();
            bool isSent = co_await stream_.writeAll(out_);
            out_.clear();
            if (!isSent)
                co_return outcome_;
            outcome_.bodyBytes += piece.size();
            if (rest.empty())
                break;
        }
        outcome_.isComplete = isLast;
        if (news_.isOver)
            co_return outcome_;
        onProgress(); // a job that computes is no client that does not read
        co_await nextNews();
        if (!news_.isOver && (stream_.hasClientLeft() || isOverTime()))
            co_return outcome_;
    }
}

// A chunk leaves as a whole: size, bytes and end in one call. The last one is empty (RFC 9112 §7.1).
void JobAnswer::appendPiece(std::string_view piece, bool isLast) {
    bool isChunked = framing_ == BodyFraming::chunked;
    if (isChunked && !piece.empty()) {
        char size[24];
        std::snprintf(size, sizeof size, "%zx\r\n", piece.size());
        out_.append(size).append(piece).append("\r\n");
    } else {
        out_.append(piece);
    }
    if (isChunked && isLast)
        out_.append("0\r\n\r\n");
}

} // namespace stipple::server
