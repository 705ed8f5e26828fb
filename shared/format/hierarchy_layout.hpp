// Which nodes share a hierarchy chunk, and in which order nodes lie in the file.
#pragma once

#include "shared/geometry/node_key.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace stipple {

// The octree above a set of nodes: breadth first, each level in Morton order, so the children of a node
// follow each other in the order of their index.
struct OctreeNode {
    NodeKey key;
    std::uint8_t childMask = 0;
    bool childrenElsewhere = false; // in a chunk of their own
    std::size_t firstChild = 0;     // index; the others follow
    std::uint64_t descendants = 0;
    std::ptrdiff_t source = -1; // index in the keys given; -1 for a node that was completed
};
// `keys` are distinct; missing ancestors, the root at least, are added.
std::vector<OctreeNode> completeOctree(const std::vector<NodeKey>& keys);

struct ChunkPlan {
    std::ptrdiff_t parent = -1;      // index of the node whose children begin the chunk; -1: the root does
    std::vector<std::size_t> nodes;  // indices, breadth first
    std::size_t firstChildChunk = 0; // index of the chunk of the first node with childrenElsewhere
};
// The chunks, breadth first, the root's first; marks nodes whose children are elsewhere.
std::vector<ChunkPlan> planChunks(std::vector<OctreeNode>& nodes);

} // namespace stipple
