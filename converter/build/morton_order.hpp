// Points in the one order that the converter works in: by Morton code of their integers in the root cube,
// then by their attributes' bytes. So a point's place depends on the points alone, not on how they came in,
// and the points of any octree node are neighbours.
#pragma once

#include "converter/build/point_store.hpp"
#include "shared/base/result.hpp"
#include "shared/geometry/node_key.hpp"

#include <atomic>
#include <cstdint>
#include <vector>

namespace stipple {

// The indices of all points of `store`, in that order. Every point must lie in `cube`.
// Cost: 32 bytes a point while it runs.
Result<std::vector<std::uint32_t>> mortonOrder(const PointStore& store, const RootCube& cube, int threads,
                                               const std::atomic<bool>* stop);

// Negative, 0 or positive as the Morton code of `a` is less than, equal to or greater than that of `b`
// (coordinates >= 0): decided by the axis in which they differ in the highest bit.
int compareMorton(Vec3i a, Vec3i b);

} // namespace stipple
