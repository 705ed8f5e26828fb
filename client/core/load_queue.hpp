// Turns the list of what is wanted, renewed each time the selection runs, into byte requests: within limits
// of requests and bytes, which are fitted to the network that is measured on the way; neighbouring ranges
// merged; requests nobody wants any more cancelled, unless they are nearly here. Every item that was asked
// for is answered by take(), unless it was cancelled.
//
// Failures that may pass are tried again, a bounded number of times, after pauses that grow. Where the
// network or the server failed, the whole source pauses, for as long as the server asks for at least; one
// that goes on failing is stopped: nothing is asked of it until retry().
//
// Thread: one. Sources may answer inside read().
#pragma once

#include "client/core/byte_ranges.hpp"
#include "client/core/counters.hpp"
#include "client/core/load_item.hpp"
#include "client/core/load_limits.hpp"
#include "client/core/transfer_estimate.hpp"
#include "shared/io/byte_source.hpp"

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace stipple {

class LoadQueue {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr int maxAttempts = 4;
    static constexpr int maxNetworkAttempts = 8; // of an item, while others of its source come
    static constexpr int maxCutAttempts = 2;     // of one whose answer ends too early
    // Before attempt 2, 3 and 4: 250 ms, 1 s, 4 s, each up to a quarter more or less, so that clients who
    // failed together don't come back together.
    Clock::duration pauseAfter(int attempts) const;

    // Counters outlive the queue. `seed` decides the pauses.
    explicit LoadQueue(SessionCounters& counters, std::uint64_t seed = 0);
    ~LoadQueue();

    void addSource(std::uint32_t cloud, ByteSource& source); // outlives the queue, or removeSource
    // Cancels what is on its way from there and forgets what waits; none of it is answered.
    void removeSource(std::uint32_t cloud);

    // Replaces what waits, most urgent first, and cancels requests of which nothing is wanted any more.
    // An item whose key is on its way already stays as it was asked for; those of a stopped source are
    // dropped.
    void want(std::vector<LoadItem> items);
    // Sends requests while limits allow. `bytesHeld`: received, but not yet worked off elsewhere; they
    // count as on their way.
    void start(const LoadLimits& limits, std::uint64_t bytesHeld, Clock::time_point now);
    // The limits for the network as it is known by now, within `most`.
    LoadLimits fitted(const LoadLimits& most) const { return adaptedLimits(most, estimate_, isPipeShort_); }
    // What arrived, or failed for good, since the last call.
    std::vector<Loaded> take(Clock::time_point now);
    // The gaps in it.
    std::vector<LoadedGap> takeGaps() { return std::exchange(gaps_, {}); }

    bool hasArrivals() const { return !arrivals_.empty(); }
    int requestsInFlight() const { return requestsInFlight_; }
    bool idle() const { return waiting_.empty() && requests_.empty() && arrivals_.empty(); }
    bool awaits(std::uint32_t cloud) const; // a request to that source is on its way
    // The earliest time at which an item that waits after a failure may be asked for, of one source or of
    // all; max() if none does.
    Clock::time_point nextRetry(std::optional<std::uint32_t> cloud = std::nullopt) const;
    // Why what waits for another attempt, or is on its way by one, failed before; nothing if nothing does.
    std::optional<Error> passingFailure(std::optional<std::uint32_t> cloud = std::nullopt) const;
    const TransferEstimate& network() const { return estimate_; }

    // Why nothing more is asked of a source; nothing if it isn't stopped.
    std::optional<Error> stopped(std::uint32_t cloud) const;
    // Forgets the failures of a source and its items.
    void retry(std::uint32_t cloud);

  private:
    struct Request;
    struct Arrival {
        std::uint64_t request;
        Result<Bytes> bytes;
        bool isImmediate; // inside read(): no network was involved
    };
    struct Failure {
        int attempts = 0;
        Clock::time_point notBefore;
        Error last;
    };
    struct Source {
        ByteSource* bytes = nullptr;
        int failures = 0; // of the network or the server, since anything came
        Clock::time_point notBefore{};
        Error last;
        bool isStopped = false;
        ByteRanges received;
    };

    Clock::time_point notBefore(const LoadItem& item) const;
    void send(std::vector<LoadItem> items, Clock::time_point now);
    void lookAtProgress(Clock::time_point now);
    std::uint64_t partBytes() const;
    bool isComing(std::uint32_t cloud, ByteRange range) const;
    bool isNearlyHere(const Request& request) const;
    void keepGaps(const Request& request, const Bytes& bytes);
    void noteArrival(const Request& request, const Arrival& arrival, Clock::time_point now);
    void noteFailure(Source& source, const Error& error, Clock::time_point now);
    void cancel(Request& request);
    void settle(Request& request, Result<Bytes> bytes, Clock::time_point now, std::vector<Loaded>& loaded);
    void fail(LoadItem item, const Error& error, Clock::time_point now, std::vector<Loaded>& loaded);

    SessionCounters& counters_;
    const std::uint64_t seed_;
    TransferEstimate estimate_;
    std::map<std::uint32_t, Source> sources_;
    std::vector<LoadItem> waiting_; // most urgent first
    std::map<std::uint64_t, Request> requests_;
    std::map<LoadKey, std::uint64_t> travelling_; // item → request
    std::map<LoadKey, Failure> failures_;
    std::vector<Arrival> arrivals_;
    std::vector<LoadedGap> gaps_;
    std::shared_ptr<LoadQueue*> self_;
    std::uint64_t lastRequest_ = 0, reading_ = 0; // reading_: the request whose read() is running
    std::uint64_t letFinishBytes_ = LoadLimits{}.letFinishBytes;
    bool letsUnbegunFinish_ = false;
    bool isPipeShort_ = false; // so many requests hold no more than the network does
    int requestsInFlight_ = 0;
    std::uint64_t bytesInFlight_ = 0;
};

} // namespace stipple
