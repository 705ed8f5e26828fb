// Phase 3: each point goes to exactly one node.
//
// Bottom-up, level by level. A node's *sample* is chosen among the samples of its children (of a leaf: all
// its points) so that no two of its points are nearer than the level's minimum distance; what a node keeps is
// its sample without what its parent then takes. So coarse nodes are thinned versions of what is below them
// and leaves keep the rest, duplicates included.
//
// Points are visited in bit-reversed Morton order, block by block, which spreads them evenly. Nodes of one
// level are worked on in eight rounds, by the parity of their coordinates: nodes of one round do not touch,
// and a later round keeps its distance from what earlier rounds took near the border. So the minimum distance
// holds across borders too, and the outcome does not depend on the number of threads. A subtree keeps the
// same distance from neighbouring subtrees that were sampled before it.
#pragma once

#include "converter/build/spacing.hpp"
#include "converter/build/subtree.hpp"

#include <atomic>
#include <span>
#include <unordered_map>
#include <vector>

namespace stipple {

// Sample points of a subtree's nodes that lie near the subtree's own faces.
using Borders = std::unordered_map<NodeKey, std::vector<Vec3i>, NodeKeyHash>;

struct Sampled {
    // Parallel to Subtree::nodes(): what each keeps, as ranks, rising. May be empty. The first is the sample
    // of the subtree's root, which the nodes above may take from.
    std::vector<std::vector<std::uint32_t>> kept;
    Borders borders;
};

// `neighbours`: of the touching subtrees that were sampled before.
Result<Sampled> sample(const Subtree& subtree, const Spacing& spacing,
                       std::span<const Borders* const> neighbours, int threads,
                       const std::atomic<bool>* stop);

} // namespace stipple
