// How far apart the points of inner nodes are kept, and how that distance is measured.
#pragma once

#include "converter/build/tile.hpp"
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

// The minimum distance in a node of level `level` is `unit` × sqrt(2^(2 × nodeBits - density)): a node is
// 2^(density / 2) minimum distances wide.
struct Spacing {
    DistanceMetric metric;
    int density = 16; // 2 to 16

    double squaredSteps(int nodeBits) const; // the square of the distance, in weighted steps
    double world(int nodeBits) const;        // never more than what sampling keeps
};

// The densest spacing (nodes 2 to 256 distances wide) at which inner nodes hold their target on average: 256
// on surfaces, less where points fill a volume. Estimated from the number of cells of that size that points
// lie in.
Result<Spacing> chooseSpacing(const Tiles& tiles, const DistanceMetric& metric, int threads,
                              const std::atomic<bool>* stop);

} // namespace stipple
