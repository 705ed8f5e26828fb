// Phases 3 and 4: the cells' points become nodes of the octree, sampled and encoded.
//
// The octree is built in tiers of subtrees, from the leaves up. A subtree of the first tier is loaded from
// its cells, sorted, split and sampled; all its nodes but the root are encoded, put aside and forgotten. The
// root's sample (a few per cent of the points) waits for the next tier, whose subtrees are made of such
// samples, and so on up to the root of the cloud. So memory is bounded by the subtrees at work, and each
// point is encoded once.
#pragma once

#include "converter/build/built_subtree.hpp"
#include "converter/build/spacing.hpp"
#include "converter/build/tile.hpp"

namespace stipple {

struct BuildOptions {
    int threads = 1;
    std::uint64_t memoryBytes = 0; // for the subtrees at work
    const std::atomic<bool>* stop = nullptr;
    std::uint64_t subtreeBytes = WorkSizes{}.subtreeBytes;
};

struct Built {
    Spacing spacing;
    std::vector<StoredNode> nodes; // their blocks lie in the scratch file `blocks`
    BatchStatistics statistics;
    PointHash hash;
    std::uint64_t points = 0;
};

// `metadata` is complete but for what is in Built. `blocks` and `journal` are of the work folder: subtrees
// that the journal has are not built again. Takes the points out of `tiles`.
Result<Built> build(Tiles& tiles, const CloudMetadata& metadata, const BuildOptions& options,
                    ScratchFile& blocks, Journal& journal, const ConvertProgress& progress);

} // namespace stipple
