// A node's points as the rasterizers take them. Immutable once made; a node refined by further strata is a
// new ResidentNode with the same key and a new `id`.
//
// A point is two words of position and one of colour or value (12 bytes):
//
//   word 0: y[10:0] << 21 | x[20:0]      x, y, z: the coordinates' top 21 bits, i.e. in-node grid steps
//   word 1: z[20:0] << 11 | y[20:11]<<1  >> positionShift
//
// Nodes wider than 2^21 steps (positionShift > 0, at most 10) carry a third position word with the low bits,
// so drawing stays exact however far one zooms into a coarse node:
//
//   low word: z_low << 20 | y_low << 10 | x_low, each positionShift bits
#pragma once

#include "shared/geometry/node_key.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace stipple {

inline constexpr int positionWordBits = 21;

struct ResidentNode {
    std::uint64_t id = 0; // unique in the process; key of GPU buffers
    NodeKey key;
    int nodeBits = 0;                            // the node is 2^nodeBits grid steps wide; <= maxNodeBits
    int positionShift = 0;                       // max(0, nodeBits - positionWordBits)
    std::uint32_t pointCount = 0;                // points here: a prefix of the progressive order
    std::uint32_t totalPoints = 0;               // points the node has in the file
    std::vector<std::uint32_t> positionWords;    // 2 × pointCount
    std::vector<std::uint32_t> positionLowWords; // pointCount if positionShift > 0, else empty
    std::vector<std::uint32_t> colourWords;      // pointCount: R | G << 8 | B << 16 | 255 << 24; or empty
    std::vector<float> intensity;                // pointCount raw intensities; or empty

    // What the cache counts.
    std::uint64_t sizeBytes() const {
        return sizeof *this +
               4 * (positionWords.size() + positionLowWords.size() + colourWords.size() + intensity.size());
    }
};

inline std::uint32_t packPositionWord0(std::uint32_t x, std::uint32_t y) {
    return (x & 0x1FFFFFu) | (y << 21);
}
inline std::uint32_t packPositionWord1(std::uint32_t y, std::uint32_t z) {
    return (z << 11) | ((y >> 11) << 1);
}
inline Vec3<std::uint32_t> unpackPosition(std::uint32_t word0, std::uint32_t word1) {
    return {word0 & 0x1FFFFFu, (word0 >> 21) | (((word1 >> 1) & 0x3FFu) << 11), word1 >> 11};
}

} // namespace stipple
