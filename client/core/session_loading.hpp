// The loading of a session: its clouds, what is on its way for them, and the cache of what came. It takes
// wishes, most urgent first, and says when something has changed; what is wished for is the session's.
//
// Thread: the session's.
#pragma once

#include "client/core/cloud_loader.hpp"
#include "client/core/counters.hpp"
#include "client/core/kept_bytes.hpp"
#include "client/core/load_queue.hpp"
#include "client/core/node_cache.hpp"
#include "client/core/node_decoding.hpp"
#include "client/core/point_query.hpp"
#include "client/core/region_scans.hpp"
#include "client/core/view_session.hpp"

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stipple {

class SessionLoading {
  public:
    // Decoder and counters outlive this.
    SessionLoading(NodeDecoder& decoder, SessionCounters& counters, const ViewSession::Now& now);
    ~SessionLoading();

    CloudId add(std::unique_ptr<ByteSource> source, const std::string& name, const BoxD& expected);
    bool remove(CloudId id);                 // false if there is none
    void retry(std::optional<CloudId> only); // ViewSession::retry()
    // With what is counted and measured at the time.
    CloudState stateOf(const CloudLoader& cloud) const;

    CloudMap& clouds() { return clouds_; }
    const CloudMap& clouds() const { return clouds_; }
    NodeCache& cache() { return cache_; }
    const NodeCache& cache() const { return cache_; }
    PointQueries& pointQueries() { return pointQueries_; }
    const PointQueries& pointQueries() const { return pointQueries_; }
    RegionScans& regionScans() { return regionScans_; }
    const RegionScans& regionScans() const { return regionScans_; }
    const std::deque<Error>& errors() const { return errors_; } // at most maxRecentErrors, newest last

    // Lets sources and decoder answer, waiting up to `wait` for the first if something is on its way.
    void deliver(std::chrono::milliseconds wait);

    struct Arrivals {
        bool changed = false;        // what can be drawn, or should be asked for
        std::vector<CloudId> failed; // clouds of which nothing is held any more; they may be opening again
    };
    // Works off what was delivered.
    Arrivals takeArrivals();
    // Drops what is over the limits, but nothing of nodes that frame `frame` has used.
    void limitMemory(const SessionLimits& limits, std::uint64_t frame);
    std::uint64_t compressedBytes() const;

    // Replaces what is wanted but not on its way, most urgent first.
    void want(std::vector<LoadItem> items);
    void start(const SessionLimits& limits); // sends requests while the limits allow
    LoadLimits loadLimits(const SessionLimits& limits) const;
    const TransferEstimate& network() const { return queue_.network(); }

    bool anyOpening() const;
    bool anyInterrupted() const;
    bool hasLocal() const { return !local_.empty(); } // wanted, and here without a request
    // Nothing is wanted, on its way or waiting to be worked off.
    bool idle() const;
    std::optional<Error> passingFailure() const { return queue_.passingFailure(); }

  private:
    int pumpAll(std::chrono::milliseconds wait);
    bool hasArrivals() const;
    bool isDecoding() const { return decoding_.pending() || pointQueries_.decoding(); }
    std::ptrdiff_t awaited() const;
    void takeLoaded(Loaded& loaded, Arrivals& arrivals);
    void takeRegion(CloudLoader& cloud, Loaded& loaded);
    void open(CloudLoader& cloud);
    void takeChunk(CloudLoader& cloud, std::uint32_t node, const Bytes& bytes);
    void reload(CloudLoader& cloud, Arrivals& arrivals);
    void takeFailure(CloudLoader& cloud, const LoadItem& item, const Error& error, Arrivals& arrivals);
    void failed(CloudLoader& cloud, Arrivals& arrivals);
    void release(CloudId id);
    void remember(const Error& error);

    SessionCounters& counters_;
    ViewSession::Now now_;
    NodeCache cache_;
    KeptBytes kept_;
    LoadQueue queue_;
    NodeDecoder& decoder_;
    NodeDecoding decoding_;
    PointQueries pointQueries_;
    RegionScans regionScans_;
    CloudMap clouds_;
    CloudId lastCloud_ = 0;
    std::vector<Loaded> local_; // wanted, and here without a request
    std::deque<Error> errors_;
};

} // namespace stipple
