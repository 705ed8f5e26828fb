#include "server/net/connection.hpp"

#include "server/net/body_sender.hpp"

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
    if (status != headerRead) {
        HttpRequest unknown;
        co_await sendAndLog(unknown, answerUnreadable(status), false);
        co_return false;
    }
    HttpRequest request = requestOf(parser.get());
    HttpResponse response = loop_.state().site->answer(request, std::time(nullptr));
    bool keepsAlive = wantsKeepAlive(request) && !response.closes && !loop_.isStopping();
    bool isSent = co_await sendAndLog(request, std::move(response), keepsAlive);
    co_return isSent&& keepsAlive;
}

net::awaitable<bool> Connection::sendAndLog(const HttpRequest& request, HttpResponse response,
                                            bool keepsAlive) {
    auto begin = Clock::now();
    std::string head = responseHead(response, std::time(nullptr), keepsAlive);
    SendOutcome outcome = co_await sendResponse(loop_, socket_, std::move(head), response,
                                                [this] { allow(limits_.noProgress); });
    ServerState& state = loop_.state();
    if (state.log) {
        using namespace std::chrono;
        RequestRecord record;
        record.timeMs = duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
        record.client = client_;
        record.method = request.method;
        record.target = request.target;
        record.range = request.field("Range").value_or("");
        record.status = response.status;
        record.bodyBytes = outcome.bodyBytes;
        record.milliseconds = duration<double, std::milli>(Clock::now() - begin).count();
        record.isComplete = outcome.isComplete;
        std::lock_guard lock(state.logMutex);
        state.log(record);
    }
    if (!outcome.isComplete)
        close(); // short of Content-Length, which is how the client sees it
    co_return outcome.isComplete;
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
