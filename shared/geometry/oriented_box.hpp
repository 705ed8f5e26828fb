// Boxes that are turned: a centre, full sizes along the box's own axes, and the rotation that turns x, y, z
// into these axes. Closed: the sides belong to it.
//
// The rotation is rounded to a matrix of doubles once; from there on membership is exact (half_space.hpp).
// Turns by multiples of 90 degrees about z have no rounding at all.
#pragma once

#include "shared/base/result.hpp"
#include "shared/geometry/half_space.hpp"

#include <array>
#include <optional>

namespace stipple {

// Row i is the i-th axis of the box in world coordinates: unit vectors, at right angles to each other.
using BoxAxes = std::array<Vec3d, 3>;

// About z, counter-clockwise seen from above (x east, y north).
BoxAxes axesTurned(double degrees);
// Of a unit quaternion x, y, z, w; others are scaled to one. Nothing for (0, 0, 0, 0) or where a number is
// not finite.
std::optional<BoxAxes> axesOfQuaternion(double x, double y, double z, double w);

// A full box, or with `anyHeight` an endless one along z (for axes turned about z; centre.z and size.z count
// for nothing then). invalidArgument unless all numbers are finite and of a size that half_space.hpp takes,
// and the sizes are not negative.
Result<ConvexRegion> orientedBox(Vec3d centre, Vec3d size, const BoxAxes& axes, bool anyHeight);

} // namespace stipple
