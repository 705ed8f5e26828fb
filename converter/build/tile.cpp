#include "converter/build/tile.hpp"

#include "converter/build/morton_order.hpp"
#include "shared/base/text.hpp"

#include <algorithm>

namespace stipple {

namespace {
// Which child of a node of `level` holds `p`.
int childIndex(const RootCube& cube, int level, Vec3i p) {
    int shift = cube.nodeBits(level) - 1;
    return static_cast<int>(((p.x - cube.min.x) >> shift & 1) | ((p.y - cube.min.y) >> shift & 1) << 1 |
                            ((p.z - cube.min.z) >> shift & 1) << 2);
}

bool mustSplit(const Tiles& tiles, const TileNode& node, std::uint32_t capacity) {
    if (tiles.rootCube.nodeBits(node.key.level) > maxNodeBits)
        return true; // too wide to hold points
    if (node.count <= capacity || node.key.level >= std::min(tiles.rootCube.bits, maxLevel))
        return false;
    // The first and the last in Morton order are the same: all are, and no cut separates them.
    return tiles.position(node.first) != tiles.position(node.end() - 1);
}

void split(Tiles& tiles, std::size_t index) {
    TileNode node = tiles.nodes[index];
    node.isLeaf = false;
    std::uint32_t at = node.first;
    for (int child = 0; child < 8; ++child) {
        // The order has child 0's points first, then child 1's …
        auto begin = tiles.order.begin() + at, end = tiles.order.begin() + node.end();
        auto cut = std::partition_point(begin, end, [&](std::uint32_t point) {
            return childIndex(tiles.rootCube, node.key.level, tiles.points.store.position(point)) <= child;
        });
        auto count = static_cast<std::uint32_t>(cut - begin);
        if (count > 0) {
            node.children[static_cast<std::size_t>(child)] = static_cast<std::int32_t>(tiles.nodes.size());
            TileNode below;
            below.key = node.key.child(child);
            below.first = at;
            below.count = count;
            tiles.nodes.push_back(below);
        }
        at += count;
    }
    tiles.nodes[index] = node;
}
} // namespace

Result<RootCube> rootCubeOf(const BoxI& bounds) {
    RootCube cube;
    if (bounds.empty())
        return cube;
    cube.min = bounds.min;
    for (int axis = 0; axis < 3; ++axis) {
        // Unsigned, as the difference of two 64-bit integers may not fit a signed one.
        std::uint64_t extent =
            static_cast<std::uint64_t>(bounds.max[axis]) - static_cast<std::uint64_t>(bounds.min[axis]);
        if (extent >> maxRootBits)
            return Error{ErrorCode::outOfRange,
                         cat("the points span more than 2^", maxRootBits, " grid steps in ", "xyz"[axis]), "",
                         "remove stray points, or convert the inputs apart from each other"};
        while (extent >> cube.bits)
            ++cube.bits;
    }
    return cube;
}

Result<Tiles> tile(LoadedPoints points, std::uint32_t capacity, int threads, const std::atomic<bool>* stop) {
    Tiles tiles;
    tiles.points = std::move(points);
    STIPPLE_TRY(cube, rootCubeOf(tiles.points.bounds));
    tiles.rootCube = cube;
    STIPPLE_TRY(order, mortonOrder(tiles.points.store, cube, threads, stop));
    tiles.order = std::move(order);
    if (tiles.order.empty())
        return tiles;
    TileNode root;
    root.count = static_cast<std::uint32_t>(tiles.order.size());
    tiles.nodes.push_back(root);
    for (std::size_t i = 0; i < tiles.nodes.size(); ++i)
        if (mustSplit(tiles, tiles.nodes[i], capacity))
            split(tiles, i);
    return tiles;
}

} // namespace stipple
