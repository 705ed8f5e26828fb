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

// No candidate.
inline constexpr std::uint32_t nobody = ~std::uint32_t{0};

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
    // Sets for each candidate who represents it: itself if it is chosen, else a chosen one that is near (the
    // nearest of those that excluded it, or the one in its cell), or `nobody` if none is known. Thread: any,
    // each as another `worker`.
    virtual void choose(const Candidates& candidates, int worker,
                        std::span<std::uint32_t> representatives) = 0;
    // All nodes of a level, `begin` to `end`, have been chosen for.
    virtual void finishLevel(std::size_t begin, std::size_t end) = 0;
    // What subtrees that touch this one and are sampled later have to know. Once, at the end.
    virtual Borders takeBorders() = 0;
};

// `neighbours`: of the touching subtrees that were sampled before. `wantsRepresentatives`: false if it is
// enough to know who is chosen; looking for others' representatives takes time. All arguments outlive the
// chooser.
std::unique_ptr<Chooser> makeChooser(Sampling sampling, const Subtree& subtree, const Spacing& spacing,
                                     std::span<const Borders* const> neighbours, int workers,
                                     bool wantsRepresentatives);

} // namespace stipple
