// Poisson-disk sampling of given points (dart throwing, R. Cook 1986) by exclusion: whoever takes a point
// excludes all that are nearer to it than the minimum distance, so what is still free may be taken. Takes
// exactly what DiskSampler accepts in the same order, in half of the time, but needs the points in advance.
//
// Works in one node at a time. Points are best given in Morton order: those in a cell then are one run
// of memory, or a few, of which four points are compared at once. Distances are computed in float; where that
// leaves a doubt, in double. So every outcome is that of doubles.
#pragma once

#include "shared/geometry/vec3.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace stipple {

class DiskThinning {
  public:
    static constexpr std::uint32_t outside = ~std::uint32_t{0};

    // Starts a node of 2^nodeBits steps (at most 2^31). Points are in steps from its lowest corner and
    // stay the caller's until the next node; fewer than 2^32 - 2. Weights: see DistanceMetric.
    void begin(int nodeBits, Vec3d weights, double squaredDistance,
               std::span<const Vec3<std::uint32_t>> points);

    bool isFree(std::size_t index) const { return fours_[index / 4].excluded[index % 4] == 0; }
    // Excludes the points that are too near to `p`, which may lie up to the minimum distance outside the
    // node. `by`: its index, or `outside`, which takes less time (if the caller doesn't ask who excluded
    // them).
    void exclude(Vec3i p, std::uint32_t by);
    // Of a point that is not free the nearest of those that excluded it; one outside only if no other did.
    // Where floats hardly tell, one of the two nearest.
    std::uint32_t excludedBy(std::size_t index) const {
        return static_cast<std::uint32_t>(fours_[index / 4].excluded[index % 4]) - markOffset;
    }

  private:
    static constexpr std::uint32_t markOffset = 2;
    static constexpr std::int32_t outsideMark = 1; // outside + markOffset
    using Floats = float __attribute__((vector_size(16)));
    using Flags = std::int32_t __attribute__((vector_size(16)));
    // Four points that follow one another: a line of the cache.
    struct alignas(64) Four {
        Floats x, y, z; // weighted
        Flags excluded; // by whom, plus markOffset; 0: free
    };
    // Points that follow one another and lie in one cell.
    struct Run {
        std::uint32_t begin, end;
        std::uint32_t next; // in the same cell: 1 more than its number, or 0
    };
    struct Axis {
        int shift = 0, bits = 0; // a cell is 2^shift steps wide, and there are 2^bits
        std::int64_t reach = 0;  // steps to what may be too near
    };

    Axis axisOf(int nodeBits, double weight, double distance) const;
    void place();
    std::size_t cellAt(Vec3i cell) const {
        return static_cast<std::size_t>(((cell.z << axes_[1].bits | cell.y) << axes_[0].bits) | cell.x);
    }
    Vec3<float> weighted(Vec3d p) const;
    template <class Visit>
    void visitRunsNear(Vec3i p, Visit visit) const;
    template <bool isOutside>
    Flags excludeRun(const Run& run, Vec3<float> p, std::int32_t mark);
    void excludeExactly(const Run& run, Vec3d p, std::int32_t mark);

    Vec3d weights_;
    double squaredDistance_ = 0;
    // Squares of distances in float: below `near_` is too near for certain, above `far_` is not.
    float near_ = 0, far_ = 0;
    std::array<Axis, 3> axes_;
    std::span<const Vec3<std::uint32_t>> points_;
    std::vector<Four> fours_;
    // Parallel to them: squared distances of those that excluded; near_ if nobody in the node did.
    std::vector<Floats> nearest_;
    std::vector<Run> runs_;
    std::vector<std::uint32_t> heads_; // of each cell: 1 more than the number of its last run, or 0
    std::vector<std::size_t> used_;    // the cell of each run
};

} // namespace stipple
