// All points of a region, at full resolution: walks a cloud's hierarchy, passes over the nodes that lie
// outside, and has the others read, whatever the picture shows of them. Level by level, so what has come is a
// coarser look at all of the region at any time. The points themselves come from the nodes' bytes by
// PointChooser, wherever that is (a worker of the page, a test): a scan only reads.
//
//   advance()   visits known nodes, a bounded number a call
//   items()     what is to be read next; the session asks for it after all that the picture needs
//   take()      nodes that are here. What is read ahead is bounded, so a scan nobody takes from stands still
//
// A scan ends complete, or with an error: an answer that lacks some of its points is none.
//
// Thread: the session's.
#pragma once

#include "client/core/cloud_loader.hpp"
#include "client/core/region_request.hpp"
#include "shared/select/cloud_filter.hpp"
#include "shared/select/point_chooser.hpp"

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

namespace stipple {

class RegionScan {
  public:
    static constexpr std::size_t visitsPerStep = 20'000;

    // Errors: invalidArgument for a cloud that is not open, and those of CloudFilter and PointChooser.
    static Result<std::unique_ptr<RegionScan>> make(RegionScanId id, const CloudLoader& cloud,
                                                    const RegionRequest& request);

    RegionScanId id() const { return id_; }
    CloudId cloud() const { return request_.cloud; }
    // True if there is something else to ask for than before.
    bool advance(const CloudLoader& cloud);
    // More nodes are known than one call of advance() visits.
    bool mustGoOn() const { return !progress_.error && !toVisit_.empty(); }
    // Hierarchy chunks, then runs of bytes, coarse nodes first.
    std::vector<LoadItem> items(const CloudLoader& cloud, NodeCache& cache) const;
    void takeLoaded(const LoadItem& item, Result<Bytes> bytes);
    void fail(const Error& error);

    // The nodes that are here, at most so many.
    std::vector<RegionNode> take(std::size_t most);
    std::size_t ready() const { return ready_.size(); }
    const RegionProgress& progress() const { return progress_; }

  private:
    using Order = std::tuple<std::uint8_t, std::uint64_t, std::uint32_t>; // level, place in the file, index
    // A node that is asked for: runs of its bytes, in file order, and what of them has come.
    struct Asked {
        Order order;
        NodeEntry entry;
        bool tested = true;
        std::uint64_t bytes = 0;
        std::vector<ByteRange> runs;
        std::vector<std::optional<Bytes>> come;
    };
    RegionScan(RegionScanId id, RegionRequest request, std::shared_ptr<const CloudMetadata> metadata)
        : id_(id), request_(std::move(request)), metadata_(std::move(metadata)) {}
    void visit(const CloudLoader& cloud, std::uint32_t node);
    bool visitChunks(const CloudLoader& cloud);
    bool ask(const CloudLoader& cloud);
    static std::vector<ByteRange> runsOf(const NodeEntry& entry, std::span<const std::size_t> blocks);
    static std::uint64_t keyId(std::uint32_t node, std::size_t run) {
        return (std::uint64_t{run} << 32) | node;
    }
    void updateComplete();

    RegionScanId id_;
    RegionRequest request_;
    std::shared_ptr<const CloudMetadata> metadata_;
    std::unique_ptr<CloudFilter> filter_;
    std::unique_ptr<PointChooser> chooser_;
    std::deque<std::uint32_t> toVisit_;
    std::vector<std::uint32_t> chunks_;    // nodes whose children are in chunks that are not here
    std::map<Order, bool> wanted_;         // not asked for yet; is it tested?
    std::map<std::uint32_t, Asked> asked_; // by index
    std::map<Order, RegionNode> ready_;
    std::uint64_t bytesAhead_ = 0;
    RegionProgress progress_;
};

} // namespace stipple
