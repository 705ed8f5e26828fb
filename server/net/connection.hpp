// One client: reads requests one after the other (pipelined ones wait in the buffer), answers each in turn.
// Internal to server/net; lives on one loop's thread.
#pragma once

#include "server/http/request_header.hpp"
#include "server/net/loop.hpp"
#include "server/net/response_sender.hpp"
#include "server/net/stream.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace stipple::server {

class Connection {
  public:
    using Clock = std::chrono::steady_clock;

    Connection(Loop& loop, Socket socket, std::shared_ptr<const TlsContext> tls);

    // Until the client leaves, an error, a limit, or the end of the server.
    Task<void> run();

    void close(); // what is pending fails, and run() ends; what is being answered is broken off
    bool isIdle() const { return phase_ == Phase::idle; }
    bool isIdleSince(Clock::time_point before) const { return isIdle() && idleSince_ <= before; }
    bool isLate(Clock::time_point now) const { return now >= deadline_; }

  private:
    enum class Phase {
        header, // the handshake of TLS or a request's header is arriving
        idle,   // nothing of a next request has come
        answering,
    };
    // One request and what becomes of it.
    struct Exchange {
        HttpRequest request; // views of received_
        Clock::time_point begin;
        std::string job;
        int status = 499; // until there is an answer
        SendOutcome outcome;
        bool keepsAlive = false;
    };
    // What has come and is not answered yet; at most ServerLimits::requestHeaderBytes.
    struct Received {
        std::vector<char> bytes;
        std::size_t begin = 0, end = 0;
        std::string_view view() const { return {bytes.data() + begin, end - begin}; }
    };

    Task<bool> begin();
    Task<bool> readMore();
    int look(); // at what has come: needsMore, headerRead, or the status of a refusal
    void startExchange(int status);
    Task<void> answerJob(Job job);
    bool startSending(); // of answer_; false: finishSending() goes on with it
    Task<void> finishSending();
    void endSending();
    bool endExchange(); // true: the connection goes on
    Task<void> closeGently();
    HttpResponse unreadable(int status) const;
    net::ip::address client() const;
    void log(double seconds) const;
    void allow(std::chrono::milliseconds time) { deadline_ = Clock::now() + time; }

    Loop& loop_;
    const ServerLimits& limits_;
    Stream stream_;
    Received received_;
    HeaderScan scan_;
    Exchange exchange_;
    Answer answer_;
    std::string head_;
    std::optional<ResponseSender> sender_; // of head_ and answer_
    net::ip::address peer_;
    Phase phase_ = Phase::header;
    Clock::time_point deadline_, idleSince_;
    int answeredInTurn_ = 0; // without having waited for anything
};

} // namespace stipple::server
