// Accepts points one by one, each only if it keeps a minimum distance from all accepted before it
// (Poisson-disk sampling by dart throwing, R. Cook 1986, over given points). What DiskThinning samples by is
// checked by this.
//
// Works in one node at a time. Accepted points lie in a grid of cells at least twice the minimum distance
// wide, so what is too near to a point lies in the eight cells around its nearest corner. All comparisons are
// of the same numbers in the same order for any number of threads.
#pragma once

#include "shared/geometry/vec3.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace stipple {

class DiskSampler {
  public:
    // Starts a node of 2^nodeBits steps. Points are given in steps from its lowest corner.
    void begin(int nodeBits, Vec3d weights, double squaredDistance);

    // Accepts `p` (in the node) and returns true, unless it is too near to one accepted or blocked before.
    bool accept(Vec3<std::int64_t> p);
    // Takes `p`, which may lie up to the minimum distance outside the node, as accepted.
    void block(Vec3<std::int64_t> p);

  private:
    struct Axis {
        int shift = 0;          // a cell is 2^shift steps wide
        std::int32_t cells = 1; // in the node, plus one beyond each end
        bool looksBoth = false; // cells are narrower than twice the distance: look to both sides
    };
    struct Accepted {
        double x, y, z;
        std::int32_t next; // in the same cell, or -1
    };
    std::int32_t cellOf(std::int64_t coordinate, const Axis& axis) const;
    bool isNear(std::size_t cell, Vec3d p) const;
    void insert(std::size_t cell, Vec3d p);

    std::array<Axis, 3> axes_;
    Vec3d weights_;
    double squaredDistance_ = 0;
    std::vector<std::int32_t> heads_; // first accepted point of each cell, or -1
    std::vector<Accepted> accepted_;
    std::vector<std::size_t> used_; // cells with points
};

} // namespace stipple
