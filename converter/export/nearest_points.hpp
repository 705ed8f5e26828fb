// The points of a cloud that come first by some rank: nearest to a place, or first along a ray. Exact: the
// answer is that of looking at every point.
//
// Nodes are looked at best first, by a bound on the rank of every point in their cube and so in those below;
// the search ends once no node left can hold a better point. Bounds and ranks are the same sums of doubles,
// and rounding never turns an order round (a larger difference never has a smaller rounded square), so the
// bound holds to the last bit.
#pragma once

#include "shared/format/cloud_file.hpp"
#include "shared/select/cloud_filter.hpp"

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stipple {

// A rank is a number of at least 0, the less the better; equal ones go by node (level, x, y, z), then by
// index. Thread: any, once made.
class PointRank {
  public:
    virtual ~PointRank() = default;
    // Nothing: the point does not count.
    virtual std::optional<double> rankOf(Vec3d world) const = 0;
    // No point of the box ranks better; nothing: none of them counts.
    virtual std::optional<double> bestOf(const BoxD& box) const = 0;
};

// By distance from a place, in the cloud's coordinates, or in plan alone.
class DistanceRank final : public PointRank {
  public:
    // `most`: points further away do not count; infinite for all.
    DistanceRank(Vec3d place, bool inPlan, double most) : place_(place), inPlan_(inPlan), most_(most) {}
    std::optional<double> rankOf(Vec3d world) const override;
    std::optional<double> bestOf(const BoxD& box) const override;

  private:
    Vec3d place_;
    bool inPlan_;
    double most_;
};

// By distance along a ray, of the points that are near enough to it: within a radius, or within an angle seen
// from its origin. Points behind the origin do not count.
class RayRank final : public PointRank {
  public:
    // `direction` is not 0. `slope`: tangent of the angle. A point may be radius + slope × (distance along)
    // from the ray. `most`: along the ray.
    RayRank(Vec3d origin, Vec3d direction, double radius, double slope, double most)
        : origin_(origin), direction_(normalized(direction)), radius_(radius), slope_(slope), most_(most) {}
    std::optional<double> rankOf(Vec3d world) const override;
    std::optional<double> bestOf(const BoxD& box) const override;
    double distanceFromRay(Vec3d world) const;

  private:
    double alongOf(Vec3d world) const;
    bool mayMeet(const BoxD& box, double furthest) const;

    Vec3d origin_, direction_;
    double radius_, slope_, most_;
};

struct RankedPoint {
    double rank = 0;
    NodeEntry node;
    std::uint32_t index = 0; // in the node's stored order
    Vec3i position;          // grid integers

    friend bool operator<(const RankedPoint& a, const RankedPoint& b) {
        if (a.rank != b.rank)
            return a.rank < b.rank;
        return a.node.key != b.node.key ? a.node.key < b.node.key : a.index < b.index;
    }
};

struct NearestCounters {
    std::uint64_t nodesRead = 0, bytesRead = 0, pointsRanked = 0, chunksRead = 0;
};

struct NearestPoints {
    std::vector<RankedPoint> points; // best first
    NearestCounters counters;
};

// At most `count` (at least 1) of the points that pass the filter, which must be over the reader's metadata
// and without a spacing. Errors: those of reading, with the node and the file's name, `name`; cancelled once
// the gate is closed.
Result<NearestPoints> nearestPoints(CloudReader& reader, const std::string& name, const CloudFilter& filter,
                                    const PointRank& rank, std::size_t count, const WorkGate* gate);

} // namespace stipple
