// From a selection's nodes to what a rasterizer takes: the camera in each node's integers, and a style whose
// ranges are known.
#pragma once

#include "client/core/frame_plan.hpp"
#include "shared/format/cloud_metadata.hpp"

#include <memory>
#include <span>

namespace stipple {

// A world coordinate on one axis of a grid: world = offset + scale × (cell + fraction).
struct GridPosition {
    std::int64_t cell = 0;
    double fraction = 0; // [0, 1)
};
// Exact to the rounding of `fraction`: the subtraction's own rounding error is carried along, so it holds
// for offsets of any size. Positions beyond 2^61 steps are brought to there.
GridPosition gridPosition(double world, double offset, double scale);

// The first `pointCount` points of `node` as seen from `eye`.
DrawNode planNode(std::shared_ptr<const ResidentNode> node, std::uint32_t pointCount,
                  const CloudMetadata& metadata, Vec3d eye);

// `style` with ranges where it leaves them to the clouds: intensity from mean ± 2 deviations over all their
// points, within min and max; elevation from their bounds; levels from the root's to about the finest; other
// attributes from the least value to the largest. (Files have statistics of clouds, not of nodes, so ranges
// stay the same while one moves.) min < max in the answer, of all ranges that the style uses.
Style resolvedStyle(const Style& style, std::span<const std::shared_ptr<const CloudMetadata>> clouds);

} // namespace stipple
