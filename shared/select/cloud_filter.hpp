// A PointFilter made ready for one cloud: what of it can be decided by a node's place in the tree is, and the
// rest point by point.
//
// Exact: a box in world units becomes the grid integers whose world positions lie in it (grid.toWorld() never
// falls as integers rise), and polygons, rotated boxes and corridors are asked with the doubles of
// grid.toWorld().
//
// Thread: any number, once made.
#pragma once

#include "shared/base/result.hpp"
#include "shared/base/work_gate.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/format/node_entry.hpp"
#include "shared/points/point_batch.hpp"
#include "shared/select/point_filter.hpp"

#include <algorithm>
#include <array>
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
    // Where wanted points of the node and of those below it can lie (grid integers).
    BoxI boxOfWanted(const NodeEntry& entry) const;
    // Can a node below `entry` hold wanted points?
    bool wantsBelow(const NodeEntry& entry) const;
    bool wantsEverything() const { return !restricts_ && deepestLevel_ == maxLevel; }

    // The attributes whose values tests need (indices into the schema).
    const std::vector<int>& testedAttributes() const { return conditionAttributes_; }
    // Why points of a tested node were left out; a point is counted once, for the first reason.
    struct Dropped {
        std::uint64_t bySpacing = 0, byRegion = 0, byAttribute = 0;
    };
    // The rows of the points wanted, ascending. tested[i] is the column of testedAttributes()[i]. `cancelled`
    // once the gate is closed.
    Result<std::vector<std::uint32_t>> select(const NodeEntry& entry, std::span<const Vec3i> positions,
                                              std::span<const Bytes* const> tested, Dropped& dropped,
                                              const WorkGate* gate = nullptr) const;

    // Where points of a node lie along the corridor of the filter: doubles, little-endian, a column of
    // stations and one of offsets. NaN for points that are not in it. There must be a corridor. `cancelled`
    // once the gate is closed.
    Result<std::array<Bytes, 2>> placesAlong(const NodeEntry& entry, std::span<const Vec3i> positions,
                                             const WorkGate* gate = nullptr) const;
    bool hasCorridor() const { return filter_.corridor != nullptr; }

    // Every point wanted lies in it (grid integers); empty if there can be none.
    const BoxI& reach() const { return reach_; }
    int deepestLevel() const { return deepestLevel_; }

  private:
    explicit CloudFilter(const CloudMetadata& metadata) : metadata_(&metadata) {}
    Status limitRegion();
    Status limitLevels();
    Status limitAttributes();
    bool thins(const NodeEntry& entry) const;
    // How the parts of the region lie to a node's points: which of them have to be asked about each.
    struct Overlaps {
        Overlap box = Overlap::whole, polygons = Overlap::whole, convex = Overlap::whole,
                prism = Overlap::whole, corridor = Overlap::whole;
        Overlap all() const { return std::min({box, polygons, convex, prism, corridor}); }
    };
    Overlaps overlapsOf(const NodeEntry& entry) const;
    BoxI cubeOf(const NodeKey& key) const;
    BoxD worldBoxOf(const BoxI& steps) const;
    void keepInRegion(std::vector<std::uint32_t>& rows, const NodeEntry& entry, const Overlaps& overlaps,
                      std::span<const Vec3i> positions) const;

    const CloudMetadata* metadata_;
    PointFilter filter_;
    BoxI reach_;
    bool restricts_ = false; // can there be points that are not wanted?
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
