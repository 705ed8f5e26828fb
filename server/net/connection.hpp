// One client: reads requests one after the other (pipelined ones wait in the buffer), answers each in turn.
// Internal to server/net; lives on one loop's thread.
#pragma once

#include "server/net/body_sender.hpp"
#include "server/net/loop.hpp"

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <chrono>

namespace stipple::server {

class Connection {
  public:
    using Clock = std::chrono::steady_clock;

    Connection(Loop& loop, boost::asio::ip::tcp::socket socket);

    // Until the client leaves, an error, a limit, or the end of the server.
    boost::asio::awaitable<void> run();

    void close(); // what is pending fails, and run() ends
    bool isIdle() const { return isIdle_; }
    bool isLate(Clock::time_point now) const { return now >= deadline_; }

  private:
    // One request and what becomes of it.
    struct Exchange {
        HttpRequest request;
        Clock::time_point begin = Clock::now();
        std::string job;
        int status = 499; // until there is an answer
        SendOutcome outcome;
        bool keepsAlive = false;
    };
    using RequestParser = boost::beast::http::request_parser<boost::beast::http::empty_body>;
    boost::asio::awaitable<bool> waitForRequest();
    boost::asio::awaitable<int> readHeader(RequestParser& parser);
    boost::asio::awaitable<bool> answerNext(); // true: the connection goes on
    boost::asio::awaitable<void> answerJob(Exchange& exchange, Job job);
    boost::asio::awaitable<void> sendWhole(Exchange& exchange, const HttpResponse& response);
    HttpResponse unreadable(int status) const;
    void log(const Exchange& exchange) const;
    boost::asio::awaitable<void> closeGently();
    void cut();
    void allow(std::chrono::milliseconds time) { deadline_ = Clock::now() + time; }

    Loop& loop_;
    const ServerLimits& limits_;
    boost::asio::ip::tcp::socket socket_;
    boost::beast::flat_buffer buffer_;
    std::string client_;
    Clock::time_point deadline_;
    bool isIdle_ = true;
};

} // namespace stipple::server
