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
// holds across borders too, and the outcome does not depend on the number of threads.
#pragma once

#include "converter/build/spacing.hpp"
#include "converter/build/tile.hpp"

#include <vector>

namespace stipple {

struct Sampled {
    double rootSpacing = 0; // world units
    // Parallel to Tiles::nodes: what each keeps, as ranks in Tiles::order, rising. May be empty.
    std::vector<std::vector<std::uint32_t>> kept;
};

Result<Sampled> sample(const Tiles& tiles, const Spacing& spacing, int threads, const std::atomic<bool>* stop,
                       const ConvertProgress& progress);

} // namespace stipple
