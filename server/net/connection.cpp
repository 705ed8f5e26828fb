#include "server/net/connection.hpp"

#include "server/http/problem.hpp"
#include "server/net/job_answer.hpp"

#include <algorithm>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/http/error.hpp>
#include <ctime>
#include <sys/socket.h>

namespace stipple::server {

namespace {

namespace net = boost::asio;
namespace http = boost::beast::http;
using Tcp = net::ip::tcp;
using Failure = boost::system::error_code;
constexpr auto answered = net::as_tuple(net::use_awaitable);
constexpr std::chrono::milliseconds lingerTime{1000};
constexpr std::chrono::hours untilTheJobSays{24 * 365}; // it has limits of its own
constexpr std::size_t readBytes = 4096;
// Outcomes of readHeader beside the status of a refusal.
constexpr int headerRead = 0, clientLeft = -1;

// Status for bytes that the parser refused.
int statusOf(const Failure& error) {
    if (error == http::error::header_limit || error == http::error::buffer_overflow)
        return 431;
    return error == http::error::bad_version ? 505 : 400;
}

std::string_view view(boost::beast::string_view text) {
    return {text.data(), text.size()};
}

template <class Message>
HttpRequest requestOf(const Message& message) {
    HttpRequest request;
    request.method = view(message.method_string());
    request.target = view(message.target());
    request.version = static_cast<int>(message.version());
    for (const auto& field : message)
        request.fields.emplace_back(view(field.name_string()), view(field.value()));
    return request;
}

bool wantsKeepAlive(const HttpRequest& request) {
    if (request.version != 11)
        return false;
    std::string value = request.field("Connection").value_or("");
    for (std::string_view rest = value; !rest.empty();) {
        std::size_t comma = std::min(rest.find(','), rest.size());
        if (equalIgnoringCase(trimmed(rest.substr(0, comma)), "close"))
            return false;
        rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
    return true;
}

} // namespace

Connection::Connection(Loop& loop, Tcp::socket socket)
    : loop_(loop), limits_(loop.state().limits), socket_(std::move(socket)),
      buffer_(loop.state().limits.requestHeaderBytes) {
    Failure ignored;
    socket_.set_option(Tcp::no_delay(true), ignored);
    socket_.native_non_blocking(true, ignored); // for sendfile
    auto endpoint = socket_.remote_endpoint(ignored);
    client_ = ignored ? "-" : endpoint.address().to_string();
    allow(limits_.idle);
}

void Connection::close() {
    Failure ignored;
    socket_.close(ignored);
}

net::awaitable<void> Connection::run() {
    for (bool goesOn = true; goesOn;) {
        goesOn = co_await waitForRequest();
        if (goesOn)
            goesOn = co_await answerNext();
    }
    if (socket_.is_open())
        co_await closeGently();
    close();
}

net::awaitable<bool> Connection::waitForRequest() {
    if (buffer_.size() > 0)
        co_return true; // pipelined
    if (loop_.isStopping())
        co_return false;
    isIdle_ = true;
    allow(limits_.idle);
    auto [error, size] = co_await socket_.async_read_some(
        buffer_.prepare(std::min(readBytes, limits_.requestHeaderBytes)), answered);
    buffer_.commit(size);
    isIdle_ = false;
    co_return !error;
}

// Beast bounds a single line of a header, not all of it, so the bytes are counted here: a header without end
// must not fill the memory.
net::awaitable<int> Connection::readHeader(RequestParser& parser) {
    allow(limits_.header);
    parser.header_limit(static_cast<std::uint32_t>(limits_.requestHeaderBytes));
    parser.body_limit(boost::none); // bodies are refused by the rules, with a status of their own
    std::size_t parsed = 0;
    for (;;) {
        Failure error;
        std::size_t taken = parser.put(buffer_.data(), error);
        buffer_.consume(taken);
        parsed += taken;
        if (error && error != http::error::need_more)
            co_return statusOf(error);
        if (parsed + (parser.is_header_done() ? 0 : buffer_.size()) >= limits_.requestHeaderBytes)
            co_return 431;
        if (parser.is_header_done())
            co_return headerRead;
        auto [problem, size] = co_await socket_.async_read_some(
            buffer_.prepare(std::min(readBytes, limits_.requestHeaderBytes - buffer_.size())), answered);
        buffer_.commit(size);
        if (problem)
            co_return clientLeft;
    }
}

net::awaitable<bool> Connection::answerNext() {
    RequestParser parser;
    int status = co_await readHeader(parser);
    if (status == clientLeft)
        co_return false;
    Exchange exchange;
    if (status != headerRead) {
        co_await sendWhole(exchange, unreadable(status));
    } else {
        exchange.request = requestOf(parser.get());
        exchange.keepsAlive = wantsKeepAlive(exchange.request);
        Answer answer = loop_.state().handler->answer(exchange.request, std::time(nullptr));
        if (auto* job = std::get_if<Job>(&answer))
            co_await answerJob(exchange, std::move(*job));
        else
            co_await sendWhole(exchange, std::get<HttpResponse>(answer));
    }
    log(exchange);
    if (!exchange.outcome.isComplete)
        cut(); // short of Content-Length or of the last chunk, which is how the client sees it
    co_return exchange.outcome.isComplete&& exchange.keepsAlive;
}

HttpResponse Connection::unreadable(int status) const {
    const char* detail = status == 431   ? "the header is too large"
                         : status == 505 ? "only HTTP/1.0 and HTTP/1.1 are spoken here"
                                         : "this is not an HTTP request";
    HttpResponse response = problemResponse(status, detail);
    loop_.state().handler->complete(HttpRequest(), response);
    return response;
}

net::awaitable<void> Connection::sendWhole(Exchange& exchange, const HttpResponse& response) {
    exchange.status = response.status;
    exchange.keepsAlive = exchange.keepsAlive && !response.closes && !loop_.isStopping();
    std::string head = responseHead(response, std::time(nullptr), exchange.keepsAlive);
    exchange.outcome = co_await sendResponse(loop_, socket_, std::move(head), response,
                                             [this] { allow(limits_.noProgress); });
}

net::awaitable<void> Connection::answerJob(Exchange& exchange, Job job) {
    exchange.job = job.kind;
    bool headOnly = exchange.request.method == "HEAD";
    allow(untilTheJobSays);
    JobAnswer answer(loop_, socket_, client_, std::move(job), headOnly);
    std::optional<HttpResponse> response = co_await answer.wait();
    if (!response)
        co_return;
    loop_.state().handler->complete(exchange.request, *response);
    if (!answer.isStreamed()) {
        co_await sendWhole(exchange, *response);
        co_return;
    }
    exchange.status = response->status;
    BodyFraming framing = exchange.request.version == 11 ? BodyFraming::chunked : BodyFraming::untilClose;
    exchange.keepsAlive =
        exchange.keepsAlive && framing == BodyFraming::chunked && !response->closes && !loop_.isStopping();
    std::string head = responseHead(*response, std::time(nullptr), exchange.keepsAlive, framing);
    auto onProgress = [this] { allow(limits_.noProgress); };
    if (headOnly)
        exchange.outcome = co_await sendResponse(loop_, socket_, std::move(head), *response, onProgress);
    else
        exchange.outcome = co_await answer.sendBody(std::move(head), framing, onProgress);
}

void Connection::log(const Exchange& exchange) const {
    ServerState& state = loop_.state();
    if (!state.log)
        return;
    using namespace std::chrono;
    RequestRecord record;
    record.timeMs = duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
    record.client = client_;
    record.method = exchange.request.method;
    record.target = exchange.request.target;
    record.range = exchange.request.field("Range").value_or("");
    record.job = exchange.job;
    record.status = exchange.status;
    record.bodyBytes = exchange.outcome.bodyBytes;
    record.milliseconds = duration<double, std::milli>(Clock::now() - exchange.begin).count();
    record.isComplete = exchange.outcome.isComplete;
    std::lock_guard lock(state.logMutex);
    state.log(record);
}

// A reset, not an orderly end: where an answer reaches until the end of the connection, that is the only
// difference between a whole one and half of one.
void Connection::cut() {
    Failure ignored;
    socket_.set_option(net::socket_base::linger(true, 0), ignored);
    close();
}

// Closing a socket with unread bytes resets the connection, and the client may lose the answer that it has
// not read yet (RFC 9112 §9.6): say that no more comes, then read what the client still sends, for a moment.
net::awaitable<void> Connection::closeGently() {
    Failure problem;
    socket_.shutdown(Tcp::socket::shutdown_send, problem);
    allow(lingerTime);
    buffer_.consume(buffer_.size());
    while (!problem && !loop_.isStopping()) {
        auto [error, size] =
            co_await socket_.async_read_some(buffer_.prepare(limits_.requestHeaderBytes), answered);
        problem = error;
    }
}

} // namespace stipple::server
