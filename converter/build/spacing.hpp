// How far apart the points of inner nodes are kept.
#pragma once

#include "converter/build/subtree.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/select/distance_metric.hpp"

#include <array>
#include <vector>

namespace stipple {

// The distance at which points of a node of level `level` are chosen (how: chooser.hpp) is `unit` × sqrt(2^(2
// × nodeBits - density)): a node is 2^(density / 2) such distances wide.
struct Spacing {
    static constexpr int densest = 16;
    DistanceMetric metric;
    int density = densest; // 2 to 16

    double squaredSteps(int nodeBits) const; // the square of the distance, in weighted steps
    double world(int nodeBits) const;        // never more than what sampling keeps
};

// The densest spacing (nodes 2 to 256 distances wide) at which inner nodes hold their target on average: 256
// on surfaces, less where points fill a volume. Estimated, over the subtrees that are added, from the number
// of cells of that size that points lie in.
class SpacingEstimate {
  public:
    explicit SpacingEstimate(const DistanceMetric& metric);
    void add(const Subtree& subtree);
    void add(const SpacingEstimate& other);
    Spacing choose(Sampling sampling) const;

    // The octree cells d levels below a node that hold points, for d = 0, 1, …
    using CellCounts = std::array<double, Spacing::densest / 2 + 1>;

  private:
    DistanceMetric metric_;
    std::vector<CellCounts> nodes_; // of inner nodes
};

} // namespace stipple
