// Vectors, boxes, the grid, and node keys.
#include "shared/geometry/box.hpp"
#include "shared/geometry/grid.hpp"
#include "shared/geometry/node_key.hpp"
#include "shared/geometry/vec3.hpp"

#include <catch2/catch.hpp>

#include <random>
#include <set>
#include <unordered_set>

using namespace stipple;

TEST_CASE("vectors add, scale, and multiply both ways") {
    Vec3d a{1, 2, 3}, b{4, -5, 6};
    CHECK(a + b == Vec3d{5, -3, 9});
    CHECK(a - b == Vec3d{-3, 7, -3});
    CHECK(a * 2.0 == Vec3d{2, 4, 6});
    CHECK(dot(a, b) == 12);
    CHECK(cross(a, b) == Vec3d{27, 6, -13});
    CHECK(length(Vec3d{2, 3, 6}) == 7);
    CHECK(normalized(Vec3d{0, 0, -2}) == Vec3d{0, 0, -1});
    CHECK(normalized(Vec3d{}) == Vec3d{});
    a[1] = 9;
    CHECK(a.y == 9);
}

TEST_CASE("a default box is empty, and takes points and boxes in") {
    BoxI box;
    CHECK(box.empty());
    CHECK(!box.contains(Vec3i{0, 0, 0}));
    box.extend(BoxI{});
    CHECK(box.empty());
    box.extend(Vec3i{1, -2, 3});
    CHECK(!box.empty());
    CHECK(box.min == box.max);
    BoxI other;
    other.extend(Vec3i{-1, 5, 3});
    box.extend(other);
    CHECK(box.min == Vec3i{-1, -2, 3});
    CHECK(box.max == Vec3i{1, 5, 3});
    CHECK(box.contains(Vec3i{1, 5, 3}));
    CHECK(!box.contains(Vec3i{1, 5, 4}));
}

TEST_CASE("grid integers and world coordinates go both ways") {
    Grid grid{{0.01, 0.001, 2}, {500000, 4e6, -100}};
    CHECK(grid.toWorld({0, 0, 0}) == grid.offset);
    Vec3i steps{123456, -98765, 7};
    Vec3d back = grid.toSteps(grid.toWorld(steps));
    for (int axis = 0; axis < 3; ++axis)
        CHECK(std::llround(back[axis]) == steps[axis]);
}

TEST_CASE("children count their halves in bits, and know their parent") {
    NodeKey key{3, 5, 2, 7};
    std::set<NodeKey> children;
    for (int i = 0; i < 8; ++i) {
        NodeKey child = key.child(i);
        CHECK(child.parent() == key);
        CHECK(child.indexInParent() == i);
        CHECK(child.x == 10 + static_cast<unsigned>(i & 1));
        CHECK(child.y == 4 + static_cast<unsigned>((i >> 1) & 1));
        CHECK(child.z == 14 + static_cast<unsigned>((i >> 2) & 1));
        children.insert(child);
    }
    CHECK(children.size() == 8);
    CHECK(key.text() == "3-5-2-7");
}

TEST_CASE("keys of a level hash without collisions to speak of") {
    std::unordered_set<std::size_t> hashes;
    for (std::uint32_t x = 0; x < 32; ++x)
        for (std::uint32_t y = 0; y < 32; ++y)
            for (std::uint32_t z = 0; z < 32; ++z)
                hashes.insert(NodeKeyHash{}({5, x, y, z}));
    CHECK(hashes.size() >= 32 * 32 * 32 - 8);
}

TEST_CASE("every point lies in the node its key names, at every level") {
    std::mt19937_64 random(3);
    for (int bits : {4, 31, 32, 52}) {
        RootCube cube{{-1000, 77, std::int64_t{1} << 40}, bits};
        for (int round = 0; round < 200; ++round) {
            std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
            Vec3i p{cube.min.x + static_cast<std::int64_t>(random() & mask),
                    cube.min.y + static_cast<std::int64_t>(random() & mask),
                    cube.min.z + static_cast<std::int64_t>(random() & mask)};
            for (int level = 0; level <= std::min(bits, maxLevel); ++level) {
                NodeKey key = cube.keyOf(p, level);
                Vec3i low = cube.nodeMin(key);
                std::int64_t side = std::int64_t{1} << cube.nodeBits(level);
                for (int axis = 0; axis < 3; ++axis) {
                    REQUIRE(p[axis] >= low[axis]);
                    REQUIRE(p[axis] - low[axis] < side);
                }
                if (level > 0)
                    REQUIRE(key.parent() == cube.keyOf(p, level - 1));
            }
        }
    }
}
