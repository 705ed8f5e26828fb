// The address of an octree node, and the root cube it lies in.
//
// The root cube has a side of 2^bits grid steps and starts at `min` (grid integers). The node at level L
// with coordinates (x, y, z) is the cube of side 2^(bits-L) steps at min + (x, y, z) × side. So where a
// point belongs is a shift of its integers: no floating-point comparison ever decides it.
#pragma once

#include "shared/geometry/vec3.hpp"

#include <compare>
#include <cstdint>
#include <functional>
#include <string>

namespace stipple {

// A root cube of 2^52 steps is the widest whose integers a double still holds exactly.
inline constexpr int maxRootBits = 52;
// A node that holds points is at most 2^31 steps wide, so in-node coordinates fit 31 bits. Wider nodes
// (rootBits > 31 only) hold no points and have children only.
inline constexpr int maxNodeBits = 31;
// The deepest level: a node is one grid step wide at level rootBits; coordinates stay within 32 bits.
inline constexpr int maxLevel = 31;

struct NodeKey {
    std::uint8_t level = 0;
    std::uint32_t x = 0, y = 0, z = 0; // each in [0, 2^level)

    friend auto operator<=>(const NodeKey&, const NodeKey&) = default;

    // Child 0..7: bit 0 is the upper half in x, bit 1 in y, bit 2 in z.
    NodeKey child(int index) const {
        return {static_cast<std::uint8_t>(level + 1), 2 * x + static_cast<std::uint32_t>(index & 1),
                2 * y + static_cast<std::uint32_t>((index >> 1) & 1),
                2 * z + static_cast<std::uint32_t>((index >> 2) & 1)};
    }
    NodeKey parent() const { return {static_cast<std::uint8_t>(level - 1), x / 2, y / 2, z / 2}; }
    int indexInParent() const { return static_cast<int>((x & 1) | ((y & 1) << 1) | ((z & 1) << 2)); }
    std::string text() const { // "level-x-y-z", as in URLs
        return std::to_string(level) + "-" + std::to_string(x) + "-" + std::to_string(y) + "-" +
               std::to_string(z);
    }
};

struct NodeKeyHash {
    std::size_t operator()(const NodeKey& key) const {
        std::uint64_t h = key.x * 0x9E3779B97F4A7C15ull + key.y;
        h = (h ^ (h >> 29)) * 0xBF58476D1CE4E5B9ull + key.z;
        h = (h ^ (h >> 32)) * 0x94D049BB133111EBull + key.level;
        return static_cast<std::size_t>(h ^ (h >> 31));
    }
};

struct RootCube {
    Vec3i min;    // grid integers of the cube's lowest corner
    int bits = 0; // side = 2^bits steps; 0..maxRootBits

    int nodeBits(int level) const { return bits - level; }
    Vec3i nodeMin(const NodeKey& key) const {
        int shift = nodeBits(key.level);
        return {min.x + (static_cast<std::int64_t>(key.x) << shift),
                min.y + (static_cast<std::int64_t>(key.y) << shift),
                min.z + (static_cast<std::int64_t>(key.z) << shift)};
    }
    // The node of `level` that holds `p`, which must lie in the cube.
    NodeKey keyOf(Vec3i p, int level) const {
        int shift = nodeBits(level);
        return {static_cast<std::uint8_t>(level), static_cast<std::uint32_t>((p.x - min.x) >> shift),
                static_cast<std::uint32_t>((p.y - min.y) >> shift),
                static_cast<std::uint32_t>((p.z - min.z) >> shift)};
    }
    friend bool operator==(const RootCube&, const RootCube&) = default;
};

} // namespace stipple
