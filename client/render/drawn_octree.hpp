// The octree of a frame's drawn nodes, as the vertex shader and the software renderer walk it to find how
// fine the picture is where a point lies (Potree thesis §4.3.3; the walk starts at the point's own node).
// Dynamic batching, which sorts points so that no walk is needed, is its competitor in tests/bench
// (point_batches.hpp); docs/MEASUREMENTS.md says why it is not used.
//
// One word per node, breadth first, one cloud after another:
//
//   word   firstChild << 9 | drawn << 8 | children      children: bit i is set where child i is there
//
// Child i is at firstChild + (number of bits of `children` below bit i). Nodes that are not drawn (drawn 0)
// are there where they are awaited (FramePlan::awaited), or lie between two others. In OpenGL ES the words
// are an R32UI texture, octreeTextureWidth wide, row by row.
#pragma once

#include "client/core/frame_plan.hpp"

#include <bit>
#include <cstdint>
#include <vector>

namespace stipple {

inline constexpr int octreeTextureWidth = 2048;
inline constexpr std::uint32_t drawnBit = 1u << 8;
inline constexpr int firstChildShift = 9;
// Children that firstChild could not tell apart are left out: points then seem to lie in the deepest node
// that is left. A frame has some ten thousand nodes.
inline constexpr std::size_t maxOctreeWords = std::size_t{1} << (32 - firstChildShift);

struct DrawnOctree {
    std::vector<std::uint32_t> words;
    std::vector<std::uint32_t> places; // parallel to plan.nodes: the node's word; 0 for those without points
};
DrawnOctree drawnOctree(const FramePlan& plan);

// The walk from the node at `place`, 2^nodeBits grid steps wide, down to the deepest node that holds the
// point (x, y, z), in-node grid integers. Levels below that node:
struct OctreeWalk {
    int drawn = 0;   // of the deepest drawn one; 0: the node itself; -1: nor is that, it is awaited
    int deepest = 0; // of the deepest, drawn or awaited
};
inline OctreeWalk walkOctree(const std::uint32_t* words, std::uint32_t place, int nodeBits, std::uint32_t x,
                             std::uint32_t y, std::uint32_t z) {
    std::uint32_t word = words[place];
    OctreeWalk walk{(word & drawnBit) != 0 ? 0 : -1, 0};
    for (int depth = 1; depth <= nodeBits && (word & 255u) != 0; ++depth) {
        int bit = nodeBits - depth;
        std::uint32_t octant = (x >> bit & 1u) | (y >> bit & 1u) << 1 | (z >> bit & 1u) << 2;
        if ((word >> octant & 1u) == 0)
            break;
        place = (word >> firstChildShift) +
                static_cast<std::uint32_t>(std::popcount(word & ((1u << octant) - 1u)));
        word = words[place];
        walk.deepest = depth;
        if ((word & drawnBit) != 0)
            walk.drawn = depth;
    }
    return walk;
}

inline int levelsBelow(const std::uint32_t* words, std::uint32_t place, int nodeBits, std::uint32_t x,
                       std::uint32_t y, std::uint32_t z) {
    return walkOctree(words, place, nodeBits, x, y, z).drawn;
}

} // namespace stipple
