// How the distance of a cloud's points is measured where points are kept apart.
#pragma once

#include "shared/format/cloud_metadata.hpp"

namespace stipple {

// Distance between two points of the grid: sqrt(Σ (weight × difference in steps)²) × unit world units.
// Where all scales are equal the weights are 1, so the sum is one of integers; where z is in other units than
// x and y (degrees and metres), or its scale is a hundredfold different, z has no weight: points are kept
// apart in plan.
struct DistanceMetric {
    Vec3d weights{1, 1, 1};
    double unit = 1; // world units per step of x and y
};
DistanceMetric distanceMetric(const Grid& grid, const Crs& crs);

} // namespace stipple
