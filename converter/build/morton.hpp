// Morton order: the order in which an octree is walked, of integers with the bits of x, y and z interleaved.
#pragma once

#include "shared/geometry/vec3.hpp"

namespace stipple {

// Negative, 0 or positive as the Morton code of `a` is less than, equal to or greater than that of `b`:
// decided by the axis in which they differ in the highest bit. Of coordinates below 0 the sign is the highest
// bit, and they go first.
int compareMorton(Vec3i a, Vec3i b);

} // namespace stipple
