// How the three coordinates of a node's points become one Morton key, and back.
//
// Coordinate a is origin[a] + step[a] × q[a] with 0 <= q[a] <= extent[a]; q has bitLength(extent[a]) bits.
// All bits of the three q are put in one order, most significant first: by descending level, where bit p of
// axis a has level p + lift[a], and z before y before x inside a level. The first 63 of them are
// the *key*; what is left over (only of nodes with more than 63 bits in all) are each axis's low bits:
//
//   q = [ key bits of the axis | low bits ]
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"
#include "shared/geometry/vec3.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace stipple {

inline constexpr int maxKeyBits = 63;
inline constexpr int maxLift = 3;

struct KeyLayout {
    std::array<std::uint32_t, 3> origin{}, step{1, 1, 1}, extent{};
    std::array<std::uint8_t, 3> lift{}; // 0..maxLift

    // Derived by complete().
    std::array<std::uint8_t, 3> keyBitsOf{}, lowBitsOf{};
    int keyBits = 0; // of all axes
    int lowBits = 0;
    std::array<std::uint8_t, maxKeyBits> axisOfBit{}; // key bit j (0 is the lowest) belongs to this axis

    // Fills the derived fields from the others.
    void complete();
    // q[a] moved together: x in the lowest bits, then y, then z, only the bits that are in the key.
    std::uint64_t pack(std::array<std::uint32_t, 3> q) const {
        return std::uint64_t{q[0] >> lowBitsOf[0]} | std::uint64_t{q[1] >> lowBitsOf[1]} << keyBitsOf[0] |
               std::uint64_t{q[2] >> lowBitsOf[2]} << (keyBitsOf[0] + keyBitsOf[1]);
    }
};

// Smallest origin and extent and largest step that hold `points`; no lifts; completed.
KeyLayout fitLayout(std::span<const Vec3<std::uint32_t>> points);

void writeLayout(ByteWriter& to, const KeyLayout& layout);
// Errors: truncated; corrupt if a coordinate could reach 2^nodeBits.
Result<KeyLayout> readLayout(ByteReader& from, int nodeBits);

// A permutation of 64 bits, by tables of one byte each.
class BitPermutation {
  public:
    // target[b]: where bit b goes; -1: nowhere. Later bits than `target` has go nowhere.
    explicit BitPermutation(std::span<const int> target);

    std::uint64_t operator()(std::uint64_t value) const {
        std::uint64_t result = 0;
        for (std::size_t byte = 0; byte < 8; ++byte)
            result |= tables_[byte][(value >> (8 * byte)) & 0xFF];
        return result;
    }

  private:
    std::array<std::array<std::uint64_t, 256>, 8> tables_;
};

BitPermutation keyFromPacked(const KeyLayout& layout); // packed q → key
BitPermutation packedFromKey(const KeyLayout& layout); // and back

} // namespace stipple
