// What the hierarchy knows of one node: enough to decide whether to fetch it, and which bytes.
#pragma once

#include "shared/geometry/node_key.hpp"
#include "shared/io/byte_source.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace stipple {

inline constexpr int strataCount = 4;
// A stratum's block has at least one byte for this many points (padded if need be), so what a decoder
// allocates is bounded by the bytes that came, for nodes of any number of equal points too.
inline constexpr std::uint32_t maxPointsPerByte = 16;

// Points in the first `strata` strata of a node of `pointCount` points: every 8th, 4th, 2nd, each.
inline std::uint32_t strataPrefixPoints(std::uint32_t pointCount, int strata) {
    if (strata <= 0)
        return 0;
    std::uint32_t step = 1u << (strataCount - strata);
    return static_cast<std::uint32_t>((std::uint64_t{pointCount} + step - 1) / step);
}

struct NodeEntry {
    NodeKey key;
    std::uint8_t childMask = 0; // bit c: child c exists
    std::uint32_t pointCount = 0;
    std::uint64_t offsetBytes = 0;                        // of stratum 0 in the file
    std::array<std::uint32_t, strataCount> strataBytes{}; // size of each stratum's block
    std::vector<std::uint32_t> attributeBytes;            // size of each further block, in file order
    // Where the children's entries are: size 0 when they are in this chunk (or there are none).
    ByteRange childChunk;

    // Bytes of the first `strata` strata: one contiguous range.
    ByteRange strataRange(int strata) const {
        ByteRange range{offsetBytes, 0};
        for (int s = 0; s < strata; ++s)
            range.size += strataBytes[static_cast<std::size_t>(s)];
        return range;
    }
    // Bytes of further block `index`, which follow the strata.
    ByteRange attributeRange(std::size_t index) const {
        ByteRange range{strataRange(strataCount).end(), attributeBytes[index]};
        for (std::size_t i = 0; i < index; ++i)
            range.offset += attributeBytes[i];
        return range;
    }
    std::uint64_t sizeBytes() const {
        std::uint64_t size = strataRange(strataCount).size;
        for (std::uint32_t bytes : attributeBytes)
            size += bytes;
        return size;
    }
};

} // namespace stipple
