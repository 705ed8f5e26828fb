// A network that exists on a virtual clock: one HTTP/1.1 server, a link with a delay and a bandwidth, and
// what goes wrong there. Deterministic: the same reads at the same times have the same answers at the same
// times.
//
//   read ─ waits for a connection ─ handshake ─ round trip ─ body, sharing the link ─ ready ─ pump()
//
// * The link's bandwidth is shared evenly by the answers that are on it (max-min: what one can't use, the
//   others do). Requests and headers are taken to weigh nothing but the round trip and `headerBytes`.
// * A connection begins slowly, as TCP does (RFC 5681 §3.1): in each round trip it may carry a window, which
//   grows by what it carried. It is kept open, and its window with it.
// * Taking a request back closes its connection, as browsers do with HTTP/1.1; what the server had sent by
//   then (half a round trip more) still takes its share of the link.
//
// Answers are judged by judgeRangeAnswer(), as those of real servers are. Time goes on in advance() alone.
#pragma once

#include "shared/io/byte_source.hpp"
#include "shared/io/range_answer.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace stipple::test {

struct NetworkOptions {
    double megabitsPerSecond = 50;
    std::chrono::nanoseconds roundTrip = std::chrono::milliseconds(50);
    int connections = 6;              // at once, as browsers have to one host; further requests wait in order
    int handshakeRoundTrips = 1;      // of a new connection: 1 for TCP, 2 with TLS 1.3
    double firstWindowBytes = 14'600; // ten segments (RFC 6928)
    double mostWindowBytes = 64 << 20;                           // of a connection
    double headerBytes = 300;                                    // of an answer
    std::chrono::nanoseconds timeout = std::chrono::seconds(30); // until a silent server is given up
};

struct HostedFile {
    Bytes bytes;
    std::string etag = "\"1\"";
};

struct Fault {
    enum class Kind {
        reset,       // the connection breaks when `part` of the body has come
        status,      // instead of the file
        corruptBody, // a byte of the body, at `part` of it, is another one
        wholeFile,   // 200: the server knows no ranges
        silence,     // no answer ever comes
    } kind = Kind::reset;
    double part = 0.5;
    int status = 503;
    std::string retryAfter = {};
};

struct NetworkCounters {
    std::uint64_t requests = 0; // that reached the server
    std::uint64_t connectionsOpened = 0;
    std::uint64_t bytesCarried = 0; // over the link, of bodies and headers
    std::uint64_t bytesWasted = 0;  // of those: for requests that were taken back, or whose connection broke
};

class SimulatedNetwork {
  public:
    using Time = std::chrono::steady_clock::time_point;
    using Duration = std::chrono::nanoseconds;

    explicit SimulatedNetwork(const NetworkOptions& options = {});
    ~SimulatedNetwork();

    // A source that reads the file over this network, which outlives it. What is in the file counts when a
    // request reaches the server, so it may change meanwhile.
    std::unique_ptr<ByteSource> open(std::shared_ptr<const HostedFile> file, const std::string& name);

    // Asked when a request reaches the server; `number` counts from 1.
    std::function<std::optional<Fault>(std::uint64_t number, ByteRange range)> fault;

    Time now() const;
    // Goes on until an answer is ready to be pumped, for at most `most`. True: one is.
    bool advance(Duration most);
    const NetworkCounters& counters() const;

  private:
    class Link;
    class Source;
    std::shared_ptr<Link> link_;
};

} // namespace stipple::test
