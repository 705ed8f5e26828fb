#include "server/net/connection.hpp"

#include "server/http/problem.hpp"
#include "server/net/client_address.hpp"
#include "server/net/job_answer.hpp"
#include "server/net/operations.hpp"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <cstring>
#include <ctime>

namespace stipple::server {

namespace {

constexpr std::chrono::milliseconds lingerTime{1000};
constexpr std::chrono::hours untilTheJobSays{24 * 365}; // it has limits of its own
constexpr std::size_t firstReadBytes = 2048;            // most requests are shorter
// A client that pipelines must not keep the other connections of its loop waiting.
constexpr int answersInTurn = 16;
// Outcomes of look() beside the status of a refusal.
constexpr int needsMore = -1, headerRead = 0;
constexpr int plainToTls = 1; // no status, but a 400 of its own

} // namespace

Connection::Connection(Loop& loop, Socket socket, std::shared_ptr<const TlsContext> tls)
    : loop_(loop), limits_(loop.state().limits), stream_(std::move(socket), std::move(tls)),
      peer_(stream_.peer()) {
    allow(limits_.header);
}

void Connection::close() {
    if (phase_ == Phase::answering) {
        stream_.reset();
    } else {
        stream_.finish();
        stream_.close();
    }
}

Task<void> Connection::run() {
    for (bool goesOn = co_await begin(); goesOn;) {
        int status = look();
        if (status == needsMore) {
            goesOn = co_await readMore();
            continue;
        }
        startExchange(status);
        if (auto* job = std::get_if<Job>(&answer_))
            co_await answerJob(std::move(*job));
        else if (!startSending())
            co_await finishSending();
        goesOn = endExchange();
        if (goesOn && ++answeredInTurn_ >= answersInTurn) {
            answeredInTurn_ = 0;
            co_await net::post(loop_.context(), answered);
        }
    }
    if (stream_.isOpen())
        co_await closeGently();
    stream_.close();
}

Task<bool> Connection::begin() {
    bool isOpen = co_await stream_.open();
    if (isOpen && stream_.spokePlainly()) {
        startExchange(plainToTls);
        if (!startSending())
            co_await finishSending();
        isOpen = endExchange();
    }
    if (isOpen) {
        phase_ = Phase::idle;
        allow(limits_.idle);
    }
    co_return isOpen;
}

// Waits for more of a request; its header has a deadline as a whole, from its first byte on.
Task<bool> Connection::readMore() {
    Received& in = received_;
    if (in.begin == in.end) {
        if (loop_.isStopping())
            co_return false;
        in.begin = in.end = 0;
        if (in.bytes.size() != firstReadBytes)
            in.bytes = std::vector<char>(firstReadBytes);
        phase_ = Phase::idle;
        idleSince_ = deadline_ - limits_.idle;
    } else if (in.end == in.bytes.size()) {
        std::memmove(in.bytes.data(), in.bytes.data() + in.begin, in.end - in.begin);
        in.end -= in.begin;
        in.begin = 0;
        if (in.end == in.bytes.size())
            in.bytes.resize(std::min(2 * in.end, limits_.requestHeaderBytes));
    }
    answeredInTurn_ = 0;
    std::size_t count = co_await stream_.readSome(in.bytes.data() + in.end, in.bytes.size() - in.end);
    in.end += count;
    if (phase_ == Phase::idle && count > 0) {
        phase_ = Phase::header;
        allow(limits_.header);
    }
    co_return count > 0;
}

int Connection::look() {
    HeaderScan::State state = scan_.scan(received_.view());
    if (state == HeaderScan::State::malformed)
        return 400;
    std::size_t size = state == HeaderScan::State::complete ? scan_.endBytes() : received_.view().size();
    if (size >= limits_.requestHeaderBytes)
        return scan_.isInRequestLine() ? 414 : 431;
    if (state == HeaderScan::State::needsMore)
        return needsMore;
    return parseRequestHeader(scan_.header(received_.view()), exchange_.request);
}

void Connection::startExchange(int status) {
    phase_ = Phase::answering;
    loop_.metrics().began();
    exchange_.begin = Clock::now();
    deadline_ = exchange_.begin + limits_.noProgress;
    exchange_.job.clear();
    exchange_.status = 499;
    exchange_.outcome = {};
    exchange_.keepsAlive = false;
    if (status != headerRead) {
        exchange_.request = {}; // may still be the one before
        answer_ = unreadable(status);
        return;
    }
    exchange_.keepsAlive = wantsKeepAlive(exchange_.request);
    if (auto own = answerOperations(exchange_.request, loop_.state(), peer_))
        answer_ = std::move(*own);
    else
        answer_ = loop_.state().handler->answer(exchange_.request, std::time(nullptr));
}

HttpResponse Connection::unreadable(int status) const {
    const char* detail = status == plainToTls ? "this address is https, and the request was plain http"
                         : status == 414      ? "the target is too long"
                         : status == 431      ? "the header is too large"
                         : status == 505      ? "only HTTP/1.0 and HTTP/1.1 are spoken here"
                                              : "this is not an HTTP request";
    HttpResponse response = problemResponse(status == plainToTls ? 400 : status, detail);
    loop_.state().handler->complete(HttpRequest(), response);
    return response;
}

bool Connection::startSending() {
    const auto& response = std::get<HttpResponse>(answer_);
    exchange_.status = response.status;
    exchange_.keepsAlive = exchange_.keepsAlive && !response.closes && !loop_.state().isEnding;
    head_.clear();
    appendResponseHead(head_, response, std::time(nullptr), exchange_.keepsAlive, BodyFraming::length);
    sender_.emplace(stream_, loop_.buffers(), head_, response);
    if (sender_->step() != ResponseSender::Step::done)
        return false;
    endSending();
    return true;
}

Task<void> Connection::finishSending() {
    auto step = ResponseSender::Step::pause;
    for (std::uint64_t renewedAt = 0; step != ResponseSender::Step::done; step = sender_->step()) {
        if (sender_->outcome().bodyBytes - renewedAt >= ServerLimits::progressBytes) {
            renewedAt = sender_->outcome().bodyBytes;
            allow(limits_.noProgress);
        }
        if (step == ResponseSender::Step::wait)
            co_await stream_.wait(sender_->waitsFor());
        else
            co_await net::post(loop_.context(), answered);
    }
    endSending();
}

void Connection::endSending() {
    exchange_.outcome = sender_->outcome();
    sender_.reset();
}

Task<void> Connection::answerJob(Job job) {
    exchange_.job = job.kind;
    bool headOnly = exchange_.request.method == "HEAD";
    allow(untilTheJobSays);
    JobAnswer jobAnswer(loop_, stream_, clientGroup(client()), std::move(job), headOnly);
    std::optional<HttpResponse> response = co_await jobAnswer.wait();
    if (!response)
        co_return;
    loop_.state().handler->complete(exchange_.request, *response);
    allow(limits_.noProgress);
    answer_ = std::move(*response);
    if (!jobAnswer.isStreamed()) {
        if (!startSending())
            co_await finishSending();
        co_return;
    }
    const auto& head = std::get<HttpResponse>(answer_);
    exchange_.status = head.status;
    BodyFraming framing = jobAnswer.framing(head, exchange_.request.version);
    exchange_.keepsAlive =
        exchange_.keepsAlive && framing != BodyFraming::untilClose && !head.closes && !loop_.state().isEnding;
    head_.clear();
    appendResponseHead(head_, head, std::time(nullptr), exchange_.keepsAlive, framing);
    if (headOnly)
        exchange_.outcome.isComplete = co_await stream_.writeAll(head_);
    else
        exchange_.outcome =
            co_await jobAnswer.sendBody(head_, framing, [this] { allow(limits_.noProgress); });
    // A body that is not as long as was announced: the client must not take the next answer for its rest.
    if (framing == BodyFraming::length && !headOnly && exchange_.outcome.bodyBytes != head.bodyBytes())
        exchange_.outcome.isComplete = false;
}

bool Connection::endExchange() {
    Clock::time_point now = Clock::now();
    double seconds = std::chrono::duration<double>(now - exchange_.begin).count();
    loop_.metrics().ended({exchange_.request.target, exchange_.status, exchange_.outcome.bodyBytes, seconds,
                           exchange_.outcome.isComplete});
    log(seconds);
    answer_ = HttpResponse(); // closes its files
    if (!exchange_.outcome.isComplete) {
        stream_.reset(); // short of Content-Length or of the last chunk, which is how the client sees it
        return false;
    }
    received_.begin += std::min(scan_.endBytes(), received_.view().size());
    scan_ = HeaderScan();
    phase_ = Phase::header;
    deadline_ = now + (received_.begin == received_.end ? limits_.idle : limits_.header);
    return exchange_.keepsAlive;
}

// The peer, or whom a trusted proxy names.
net::ip::address Connection::client() const {
    const auto& trusted = loop_.state().trustedProxies;
    if (trusted.empty() || std::find(trusted.begin(), trusted.end(), peer_) == trusted.end())
        return peer_;
    return forwardedClient(exchange_.request.field("X-Forwarded-For").value_or(""), peer_, trusted);
}

void Connection::log(double seconds) const {
    ServerState& state = loop_.state();
    if (!state.log)
        return;
    using namespace std::chrono;
    RequestRecord record;
    record.timeMs = duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
    record.client = client().to_string();
    record.method = exchange_.request.method;
    record.target = exchange_.request.target;
    record.version = exchange_.request.version;
    record.user = state.handler->userOf(exchange_.request);
    record.range = exchange_.request.field("Range").value_or("");
    record.referer = exchange_.request.field("Referer").value_or("");
    record.userAgent = exchange_.request.field("User-Agent").value_or("");
    record.job = exchange_.job;
    record.status = exchange_.status;
    record.bodyBytes = exchange_.outcome.bodyBytes;
    record.milliseconds = seconds * 1000;
    record.isComplete = exchange_.outcome.isComplete;
    state.log(record);
}

// Closing a socket with unread bytes resets the connection, and the client may lose the answer that it has
// not read yet (RFC 9112 §9.6): say that no more comes, then read what the client still sends, for a moment.
Task<void> Connection::closeGently() {
    stream_.finish();
    allow(lingerTime);
    char dropped[1024];
    std::size_t count = 1;
    while (count > 0 && !loop_.isStopping())
        count = co_await stream_.readSome(dropped, sizeof dropped);
}

} // namespace stipple::server
