// Normals of points as the rasterizers take them: one word a point. What a style that draws discs
// (PointShape::disc) fetches of a cloud beside positions and colours; no other does.
//
// A cloud has normals if its schema has three attributes whose names, without case and punctuation, are nx,
// ny, nz, or normalx, normaly, normalz, or, as E57 files have them, nor:normalX, nor:normalY, nor:normalZ.
// They may have any type and any length but zero; which side they are on makes no difference.
//
// A word: the direction on the octahedron |x| + |y| + |z| = 1, unfolded to a square (Meyer et al. 2010;
// Cigolle et al. 2014, "oct32"): x | y << 16, two's complement, -32767..32767 for -1..1. Off by at most
// normalWordError. Decoding is exact in integers, so that both rasterizers start from the same vector.
#pragma once

#include "client/core/node_columns.hpp"
#include "shared/geometry/vec3.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace stipple {

// A point without a direction (zero, not finite, "no value"): drawn as if it faced the camera. No direction
// has this word.
inline constexpr std::uint32_t noNormalWord = 0x80008000u;

// Between a direction and that of its word, in radians.
inline constexpr double normalWordError = 7e-5;

// Indices of the attributes with x, y and z; none if there are no normals.
std::optional<std::array<int, 3>> normalAttributes(const Schema& schema);

std::uint32_t normalWord(Vec3d normal);

// A vector in the word's direction whose |x| + |y| + |z| is 32767. Not for noNormalWord.
inline Vec3<std::int32_t> normalOfWord(std::uint32_t word) {
    auto x = static_cast<std::int32_t>(static_cast<std::int16_t>(word & 0xFFFFu));
    auto y = static_cast<std::int32_t>(static_cast<std::int16_t>(word >> 16));
    std::int32_t left = x < 0 ? -x : x, down = y < 0 ? -y : y, z = 32767 - left - down;
    if (z >= 0)
        return {x, y, z};
    return {x < 0 ? down - 32767 : 32767 - down, y < 0 ? left - 32767 : 32767 - left, z};
}

struct NodeNormals {
    std::uint64_t id = 0;             // unique among these, paints and ResidentNodes; key of GPU buffers
    std::vector<std::uint32_t> words; // a point each, in progressive order; at least all that are resident

    std::uint64_t sizeBytes() const { return sizeof *this + 4 * words.size(); }
};

// Of the node whose columns these are; null if some of them is not among them. Pure; any thread.
std::shared_ptr<const NodeNormals> packNormals(const Schema& schema,
                                               std::span<const std::shared_ptr<const NodeColumns>> columns);

} // namespace stipple
