// Half-spaces, and convex regions made of them: rotated boxes, the pieces of a profile's corridor.
//
// Whether a point belongs to one is answered exactly for the doubles given (shared/geometry/exact_sum.hpp),
// for coordinates of magnitude 1e-100 to 1e100, and 0: it depends neither on how far from the origin things
// lie nor on the order of operations.
//
// Thread: not altered once made; any number of threads may ask.
#pragma once

#include "shared/geometry/box.hpp"
#include "shared/geometry/overlap.hpp"
#include "shared/geometry/vec3.hpp"

#include <cstdint>
#include <vector>

namespace stipple {

// The points p with normal · (p - at) <= distance; closed.
struct HalfSpace {
    Vec3d normal;
    Vec3d at;
    double distance = 0;

    bool contains(Vec3d p) const;
    // `none` and `whole` are certain; `partial` may be said of a box that only touches the plane.
    Overlap overlapOf(const BoxD& box) const;
};

// The points that all of some half-spaces hold.
class ConvexRegion {
  public:
    // `bounds`: no point of the region lies outside.
    ConvexRegion(std::vector<HalfSpace> sides, const BoxD& bounds)
        : sides_(std::move(sides)), bounds_(bounds) {}

    bool contains(Vec3d p) const;
    // `none` and `whole` are certain; `partial` may be said of a box near the region that misses it.
    Overlap overlapOf(const BoxD& box) const;
    const BoxD& bounds() const { return bounds_; }

  private:
    std::vector<HalfSpace> sides_;
    BoxD bounds_;
};

} // namespace stipple
