// Phase 3: each point goes to exactly one node.
//
// Bottom-up, level by level. A node's *sample* is chosen (chooser.hpp) among the samples of its children (of
// a leaf: all its points); what a node keeps is its sample without what its parent then takes. So coarse
// nodes are thinned versions of what is below them and leaves keep the rest, duplicates included.
//
// Where nodes have to know what was chosen in their neighbours, those of one level are worked on in eight
// rounds, by the parity of their coordinates: nodes of one round do not touch, and a later round heeds what
// earlier rounds took near the border. So the outcome does not depend on the number of threads. A subtree
// heeds neighbouring subtrees that were sampled before it in the same way.
#pragma once

#include "converter/build/mean_colour.hpp"
#include "shared/base/result.hpp"

#include <atomic>

namespace stipple {

struct Sampled {
    // Parallel to Subtree::nodes(): what each keeps, as ranks, rising. May be empty. The first is the sample
    // of the subtree's root, which the nodes above may take from.
    std::vector<std::vector<std::uint32_t>> kept;
    // What these points show (mean_colour.hpp), and the sums of the sample of the subtree's root; empty if
    // there is nothing to average.
    std::vector<std::vector<std::uint16_t>> shown;
    std::vector<ColourSum> rootSums;
    Borders borders;
};

// `colours`: to average; may have no channels. `neighbours`: of the touching subtrees that were sampled
// before.
Result<Sampled> sample(Sampling sampling, const Subtree& subtree, const Spacing& spacing,
                       const ColourRows& colours, std::span<const Borders* const> neighbours, int threads,
                       const std::atomic<bool>* stop);

} // namespace stipple
