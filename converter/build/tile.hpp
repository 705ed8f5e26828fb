// Phase 2: every point has its place. The points in memory, their Morton order, and the octree over it: a
// node's points are a range of the order.
#pragma once

#include "converter/build/read_points.hpp"
#include "shared/geometry/node_key.hpp"

#include <array>

namespace stipple {

// A node with more points than this is split, if it can be. Sampling moves up to about half of a leaf's
// points to its parent, so leaves end with some 10,000 to 60,000 points.
inline constexpr std::uint32_t leafCapacity = 65536;

struct TileNode {
    NodeKey key;
    std::uint32_t first = 0, count = 0;                                   // range of Tiles::order
    std::array<std::int32_t, 8> children{-1, -1, -1, -1, -1, -1, -1, -1}; // indices into Tiles::nodes
    bool isLeaf = true;

    std::uint32_t end() const { return first + count; }
};

struct Tiles {
    LoadedPoints points;
    RootCube rootCube;
    std::vector<std::uint32_t> order; // of all points (morton_order.hpp)
    std::vector<TileNode> nodes;      // breadth-first; nodes[0] is the root; none for an empty cloud

    Vec3i position(std::uint32_t rank) const { return points.store.position(order[rank]); }
    void prefetch(std::uint32_t rank) const { points.store.prefetch(order[rank]); }
};

// The smallest cube of 2^bits steps at the lowest corner of `bounds` that holds them. outOfRange if that
// takes more than maxRootBits.
Result<RootCube> rootCubeOf(const BoxI& bounds);

Result<Tiles> tile(LoadedPoints points, std::uint32_t capacity, int threads, const std::atomic<bool>* stop);

} // namespace stipple
