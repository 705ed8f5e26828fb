// Which points are drawn with the spacing of which node, by the walk through the drawn octree and by dynamic
// batching: the same lists where both are right.
#pragma once

#include "tests/bench/point_batches.hpp"

#include <compare>
#include <cstdint>
#include <vector>

namespace stipple {

struct SizedPoint {
    std::uint32_t cloud = 0, colour = 0;
    std::uint64_t x = 0, y = 0, z = 0; // steps from the root's corner
    double spacing = 0;
    friend auto operator<=>(const SizedPoint&, const SizedPoint&) = default;
};

// Every drawn point, sorted.
std::vector<SizedPoint> sizedByWalk(const FramePlan& plan);
std::vector<SizedPoint> sizedByBatches(const PointBatches& batches);

} // namespace stipple
