// A PointFilter made ready for one cloud: what of it can be decided by a node's place in the tree is, and the
// rest point by point.
//
// Exact: a box in world units becomes the grid integers whose world positions lie in it (grid.toWorld() never
// falls as integers rise), and polygons are asked with the doubles of grid.toWorld().
//
// Thread: any number, once made.
#pragma once

#include "converter/export/point_filter.hpp"
#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/format/node_entry.hpp"
#include "shared/points/point_batch.hpp"

#include <span>
#include <vector>

namespace stipple {

class CloudFilter {
  public:
    // What is to be done with a node.
    enum class Verdict : std::uint8_t {
        outside, // no point of it lies in the region
        finer,   // its level is finer than the spacing asked for
        absent,  // no point of the cloud has the attribute values asked for
        whole,   // every point is wanted
        tested,  // point by point
    };

    // `metadata` outlives the filter. Errors: invalidArgument for attributes that the cloud does not have
    // (with those it has), empty boxes, NaN, a spacing that is no positive number.
    static Result<CloudFilter> make(const CloudMetadata& metadata, const PointFilter& filter);

    Verdict verdictOn(const NodeEntry& entry) const;
    // Can a node below `entry` hold wanted points?
    bool wantsBelow(const NodeEntry& entry) const;
    bool wantsEverything() const { return !restricts_ && !filter_.region && deepestLevel_ == maxLevel; }

    // The attributes whose values tests need (indices into the schema).
    const std::vector<int>& testedAttributes() const { return conditionAttributes_; }
    // Why points of a tested node were left out; a point is counted once, for the first reason.
    struct Dropped {
        std::uint64_t bySpacing = 0, byRegion = 0, byAttribute = 0;
    };
    // The rows of the points wanted, ascending. tested[i] is the column of testedAttributes()[i].
    std::vector<std::uint32_t> select(const NodeEntry& entry, std::span<const Vec3i> positions,
                                      std::span<const Bytes* const> tested, Dropped& dropped) const;

    // Every point wanted lies in it (grid integers); empty if there can be none.
    const BoxI& reach() const { return reach_; }
    int deepestLevel() const { return deepestLevel_; }

  private:
    explicit CloudFilter(const CloudMetadata& metadata) : metadata_(&metadata) {}
    Status limitRegion();
    Status limitLevels();
    Status limitAttributes();
    bool thins(const NodeEntry& entry) const;
    Overlap overlapOf(const NodeEntry& entry) const;
    BoxI cubeOf(const NodeKey& key) const;

    const CloudMetadata* metadata_;
    PointFilter filter_;
    BoxI reach_;
    bool restricts_ = false; // does the reach leave out part of the cloud's bounds, or are there conditions?
    int deepestLevel_ = maxLevel;
    Vec3d metric_; // world units per step of an axis, as the minimum distance is measured
    bool noneHasValues_ = false;
    std::vector<int> conditionAttributes_;
};

// "Intensity, Classification, …", for messages.
std::string attributeNames(const Schema& schema);
// Index of the attribute of that name; where there is none, of the one whose name differs only in upper and
// lower case. invalidArgument with the names there are.
Result<int> findAttribute(const Schema& schema, const std::string& name);

} // namespace stipple
