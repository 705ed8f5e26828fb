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
//
// A node has colour words (clouds with RGB), or a column of intensities (clouds whose main colour is
// intensity), or neither. Further attributes come by themselves, as NodeColumns.
#pragma once

#include "client/core/node_columns.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/format/node_points.hpp"
#include "shared/geometry/node_key.hpp"

#include <cstdint>
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
    std::uint32_t shownUnit = 0; // what its file shows is a byte of the colour word times this; 0: not so
    NodeColumns columns;         // pictureIntensity, pictureColours, or what a job without strata asked for

    // What the cache counts.
    std::uint64_t sizeBytes() const {
        return sizeof *this + 4 * (positionWords.size() + positionLowWords.size() + colourWords.size()) +
               columns.sizeBytes();
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

inline std::uint32_t packPositionLow(std::uint32_t xLow, std::uint32_t yLow, std::uint32_t zLow) {
    return zLow << 20 | yLow << 10 | xLow;
}

// Colours as the file shows them, u16 a channel, which exact ones are coded against (DecodeJob::shown). Empty
// if the node does not say (keepShownColours).
Bytes shownColours(const ResidentNode& node);
// Makes the node keep them: as a unit, or, where words have lost something, as a column.
void keepShownColours(ResidentNode& node, const NodePicture& picture);

// An id that no other ResidentNode of this process has. Any thread. Processes that decode for another one
// (Web Workers) give no ids: who takes the node in sets it.
std::uint64_t nextResidentNodeId();

// 16-bit colour channels keep their upper byte, 8-bit ones (`is8Bit`) are taken as they are, at most 255.
std::uint32_t colourWord(std::uint16_t red, std::uint16_t green, std::uint16_t blue, bool is8Bit);

// Packs decoded points, with a new id. `nodeBits` <= maxNodeBits.
ResidentNode packNode(const NodeKey& key, int nodeBits, std::uint32_t totalPoints, const NodePicture& picture,
                      PictureColour colour, bool colourIs8Bit);

// In-node grid integers of point `index` < pointCount, exact.
Vec3<std::uint32_t> positionOf(const ResidentNode& node, std::size_t index);

} // namespace stipple
