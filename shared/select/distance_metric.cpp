#include "shared/select/distance_metric.hpp"

#include <algorithm>

namespace stipple {

namespace {
constexpr double maxScaleRatio = 100;
}

DistanceMetric distanceMetric(const Grid& grid, const Crs& crs) {
    DistanceMetric metric;
    metric.unit = std::max(grid.scale.x, grid.scale.y);
    for (int axis = 0; axis < 3; ++axis)
        metric.weights[axis] = grid.scale[axis] / metric.unit;
    bool angular = crs.known() && crs.unitMeters == 0 && crs.unit.starts_with("deg");
    if (angular || metric.weights.z > maxScaleRatio || metric.weights.z < 1 / maxScaleRatio)
        metric.weights.z = 0;
    return metric;
}

} // namespace stipple
