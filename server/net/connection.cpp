#include "server/net/connection.hpp"

#include "server/net/body_sender.hpp"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <ctime>
#include <sys/socket.h>

namespace stipple::server {

namespace {

namespace net = boost::asio;
namespace http = boost::beast::http;
using Tcp = net::ip::tcp;
using Failure = boost::system::error_code;
using Parser = http::request_parser<http::empty_body>;
constexpr auto answered = net::as_tuple(net::use_awaitable);
constexpr std::chrono::milliseconds lingerTime{1000};

// Status for bytes that the parser refused; 0 if the client just left.
int statusOf(const Failure& error) {
    if (error == http::error::header_limit || error == http::error::buffer_overflow)
        return 431;
    if (error == http::error::bad_version)
        return 505;
    bool isParseError = error.category() == make_error_code(http::error::bad_method).category() &&
                        error != http::error::end_of_stream && error != http::error::partial_message;
    return isParseError ? 400 : 0;
}

std::string_view view(boost::beast::string_view text) {
    return {text.data(), text.size()};
}

HttpRequest requestOf(const Parser& parser) {
    const auto& message = parser.get();
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
    constexpr std::size_t firstRead = 4096;
    auto [error, size] = co_await socket_.async_read_some(
        buffer_.prepare(std::min(firstRead, limits_.requestHeaderBytes)), answered);
    buffer_.commit(size);
    isIdle_ = false;
    co_return !error;
}

net::awaitable<bool> Connection::answerNext() {
    allow(limits_.header);
    Parser parser;
    parser.header_limit(static_cast<std::uint32_t>(limits_.requestHeaderBytes));
    parser.body_limit(boost::none); // bodies are refused by the rules, with a status of their own
    auto [error, size] = co_await http::async_read_header(socket_, buffer_, parser, answered);
    if (error) {
        int status = statusOf(error);
        HttpRequest unknown;
        if (status != 0)
            co_await sendAndLog(unknown, answerUnreadable(status), false);
        co_return false;
    }
    HttpRequest request = requestOf(parser);
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
