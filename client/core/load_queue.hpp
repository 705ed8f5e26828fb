// Turns the list of what is wanted, renewed each time the selection runs, into byte requests: within limits
// of requests and bytes, neighbouring ranges merged, requests nobody wants any more cancelled, failures
// that may pass tried again a bounded number of times. Every item that was asked for is answered by take(),
// unless it was cancelled.
//
// Thread: one. Sources may answer inside read().
#pragma once

#include "client/core/counters.hpp"
#include "shared/io/byte_source.hpp"

#include <chrono>
#include <compare>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace stipple {

enum class LoadKind : std::uint8_t { opening, chunk, picture, attributes, points };

struct LoadKey {
    std::uint32_t cloud = 0;
    LoadKind kind = LoadKind::opening;
    std::uint64_t id = 0;   // of a node; opening: the offset
    std::int32_t block = 0; // attributes: of the node's further blocks
    friend auto operator<=>(const LoadKey&, const LoadKey&) = default;
};

struct LoadItem {
    LoadKey key;
    ByteRange range;
    int fromStrata = 0, strata = 0; // picture: the strata before these bytes and with them
    Bytes head;                     // first bytes that are here already; `range` is what is missing
    bool mayEndEarly = false;       // the file may end inside the range
};

struct Loaded {
    LoadItem item;
    Result<Bytes> bytes; // head and range together
};

struct LoadLimits {
    int requests = 6;
    std::uint64_t bytes = 8ull << 20;
    std::uint64_t mergeGapBytes = 4096;
    std::uint64_t mergedRequestBytes = 1ull << 20;
    bool mergesNodes = true; // false: only parts of one node travel together
};

class LoadQueue {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr int maxAttempts = 4;
    // Before attempt 2, 3 and 4: 250 ms, 1 s, 4 s.
    static Clock::duration pauseAfter(int attempts);

    explicit LoadQueue(SessionCounters& counters); // outlives the queue
    ~LoadQueue();

    void addSource(std::uint32_t cloud, ByteSource& source); // outlives the queue, or removeSource
    // Cancels what is on its way from there and forgets what waits; none of it is answered.
    void removeSource(std::uint32_t cloud);

    // Replaces what waits, most urgent first, and cancels requests of which nothing is wanted any more.
    // An item whose key is on its way already stays as it was asked for.
    void want(std::vector<LoadItem> items);
    // Sends requests while limits allow. `bytesHeld`: received, but not yet worked off elsewhere; they
    // count as on their way.
    void start(const LoadLimits& limits, std::uint64_t bytesHeld, Clock::time_point now);
    // What arrived, or failed for good, since the last call.
    std::vector<Loaded> take(Clock::time_point now);

    bool hasArrivals() const { return !arrivals_.empty(); }
    int requestsInFlight() const { return requestsInFlight_; }
    bool idle() const { return waiting_.empty() && requests_.empty() && arrivals_.empty(); }
    bool awaits(std::uint32_t cloud) const; // a request to that source is on its way
    // The earliest time at which an item that waits after a failure may be asked for; max() if none does.
    Clock::time_point nextRetry() const;
    // Why what waits for another attempt, or is on its way by one, failed before; nothing if nothing does.
    std::optional<Error> passingFailure() const;

  private:
    struct Request;
    struct Arrival {
        std::uint64_t request;
        Result<Bytes> bytes;
    };
    struct Failure {
        int attempts = 0;
        Clock::time_point notBefore;
        Error last;
    };

    bool mayStart(const LoadItem& item, Clock::time_point now) const;
    void send(std::vector<LoadItem> items);
    void cancel(Request& request);
    void settle(Request& request, Result<Bytes> bytes, Clock::time_point now, std::vector<Loaded>& loaded);
    void fail(LoadItem item, const Error& error, Clock::time_point now, std::vector<Loaded>& loaded);

    SessionCounters& counters_;
    std::map<std::uint32_t, ByteSource*> sources_;
    std::vector<LoadItem> waiting_; // most urgent first
    std::map<std::uint64_t, Request> requests_;
    std::map<LoadKey, std::uint64_t> travelling_; // item → request
    std::map<LoadKey, Failure> failures_;
    std::vector<Arrival> arrivals_;
    std::shared_ptr<LoadQueue*> self_;
    std::uint64_t lastRequest_ = 0;
    int requestsInFlight_ = 0;
    std::uint64_t bytesInFlight_ = 0;
};

} // namespace stipple
