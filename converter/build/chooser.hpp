// The ways to choose a node's sample among the samples of its children.
//
// * poisson: no two points are nearer than the level's minimum distance, also across the borders of nodes of
//   one level, and no more points fit (but near borders).
// * grid: of the points in each cell, about as wide as that distance, the one nearest to the cell's centre.
// * random: as many as grid would choose, by a hash of the points.
//
// All depend on the points alone: not on their order, on threads or on memory.
#pragma once

#include "converter/build/spacing.hpp"
#include "converter/build/subtree.hpp"

#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

namespace stipple {

// Sample points of a subtree's nodes that lie near the subtree's own faces.
using Borders = std::unordered_map<NodeKey, std::vector<Vec3i>, NodeKeyHash>;

struct Candidates {
    std::size_t node = 0;                       // index of Subtree::nodes()
    std::vector<std::uint32_t> ranks;           // rising, so in Morton order
    std::vector<Vec3<std::uint32_t>> positions; // of these, in steps from the node's corner
};

// Chooses for the inner nodes of one subtree, at most maxNodeBits wide, level by level from below.
class Chooser {
  public:
    virtual ~Chooser() = default;

    // Whether nodes have to know what was chosen in those that touch them: then they may not be worked on at
    // the same time.
    virtual bool heedsNeighbours() const = 0;
    // Sets `taken` (as many zeros as candidates) to 1 for those chosen. Thread: any, each as another
    // `worker`.
    virtual void choose(const Candidates& candidates, int worker, std::span<std::uint8_t> taken) = 0;
    // All nodes of a level, `begin` to `end`, have been chosen for.
    virtual void finishLevel(std::size_t begin, std::size_t end) = 0;
    // What subtrees that touch this one and are sampled later have to know. Once, at the end.
    virtual Borders takeBorders() = 0;
};

// `neighbours`: of the touching subtrees that were sampled before. All arguments outlive the chooser.
std::unique_ptr<Chooser> makeChooser(Sampling sampling, const Subtree& subtree, const Spacing& spacing,
                                     std::span<const Borders* const> neighbours, int workers);

} // namespace stipple
