#include "shared/geometry/half_space.hpp"

#include "shared/geometry/exact_sum.hpp"

#include <algorithm>
#include <cmath>

namespace stipple {

namespace {

// A value as double, and how far the exact one may be from it.
struct Estimate {
    double value = 0, error = 0;
};

// normal · (p - at) - distance. A difference is rounded once, a product once more, and three sums: the error
// is below (1 + u)^5 - 1 < 8u of the terms' sizes, with u = 2^-53.
Estimate estimateAt(const HalfSpace& side, Vec3d p) {
    double x = side.normal.x * (p.x - side.at.x);
    double y = side.normal.y * (p.y - side.at.y);
    double z = side.normal.z * (p.z - side.at.z);
    double size = std::abs(x) + std::abs(y) + std::abs(z) + std::abs(side.distance);
    return {(x + y) + (z - side.distance), 0x1p-50 * size};
}

int exactSignAt(const HalfSpace& side, Vec3d p) {
    ExactSum<13> sum;
    sum.add(-side.distance);
    for (int axis = 0; axis < 3; ++axis) {
        if (side.normal[axis] == 0) // also where a box has no end along it
            continue;
        sum.addProduct(side.normal[axis], p[axis]);
        sum.addProduct(-side.normal[axis], side.at[axis]);
    }
    return sum.sign();
}

// The corner of the box that lies furthest along the normal, or least far.
Vec3d cornerAlong(const HalfSpace& side, const BoxD& box, bool furthest) {
    Vec3d corner = side.at; // counts for nothing along axes on which the normal has no part
    for (int axis = 0; axis < 3; ++axis)
        if (side.normal[axis] != 0)
            corner[axis] = (side.normal[axis] > 0) == furthest ? box.max[axis] : box.min[axis];
    return corner;
}

} // namespace

bool HalfSpace::contains(Vec3d p) const {
    Estimate estimate = estimateAt(*this, p);
    if (std::abs(estimate.value) > estimate.error)
        return estimate.value < 0;
    return exactSignAt(*this, p) <= 0;
}

Overlap HalfSpace::overlapOf(const BoxD& box) const {
    if (contains(cornerAlong(*this, box, true)))
        return Overlap::whole;
    return contains(cornerAlong(*this, box, false)) ? Overlap::partial : Overlap::none;
}

bool ConvexRegion::contains(Vec3d p) const {
    return std::all_of(sides_.begin(), sides_.end(), [&](const HalfSpace& side) { return side.contains(p); });
}

Overlap ConvexRegion::overlapOf(const BoxD& box) const {
    for (int axis = 0; axis < 3; ++axis)
        if (box.max[axis] < bounds_.min[axis] || box.min[axis] > bounds_.max[axis])
            return Overlap::none;
    bool all = true;
    for (const HalfSpace& side : sides_) {
        Overlap overlap = side.overlapOf(box);
        if (overlap == Overlap::none)
            return Overlap::none;
        all = all && overlap == Overlap::whole;
    }
    return all ? Overlap::whole : Overlap::partial;
}

} // namespace stipple
