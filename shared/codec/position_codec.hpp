// Positions of a node, stratum by stratum (docs/FORMAT.md, "Positions").
//
// Points are coded as Morton keys in sorted order. Stratum 0 codes the differences of its keys. The key of a
// later stratum lies between those of its two neighbours in Morton order, which earlier strata have told; it
// is coded by which of them is nearer, and by how much. Equal neighbours cost nothing.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"
#include "shared/base/work_gate.hpp"
#include "shared/codec/bit_stream.hpp"
#include "shared/codec/key_layout.hpp"
#include "shared/codec/neighbour_choice.hpp"
#include "shared/format/node_entry.hpp"

#include <vector>

namespace stipple {

// The points of a node in Morton order.
struct SortedPoints {
    KeyLayout layout;
    std::vector<std::uint64_t> keys; // ascending
    std::vector<std::uint64_t> lows; // low bits, packed x, y, z from the lowest; empty if layout.lowBits is 0
    std::vector<std::uint32_t> input; // index of each point in the input
};

// Chooses the layout and sorts. Equal points stay in input order.
SortedPoints sortPoints(std::span<const Vec3<std::uint32_t>> points);

// The positions of one stratum of `points`; that of stratum 0 begins with the layout.
void encodePositions(ByteWriter& to, const SortedPoints& points, int stratum);

// How the points of stratum `stratum` > 0 relate to their neighbours; none for stratum 0.
std::vector<NeighbourChoice> neighbourChoices(std::span<const std::uint64_t> keys, int stratum);

// Decodes strata one after the other.
class PositionDecoder {
  public:
    // For the first `strata` strata of a node of `pointCount` points, at most 2^nodeBits steps wide.
    // Takes 32 bytes of memory a point; the caller has bounded their number. Everything ends with `cancelled`
    // once the gate is closed.
    PositionDecoder(std::uint32_t pointCount, int nodeBits, int strata, const WorkGate* gate = nullptr);

    // Stratum `stratum`, from where encodePositions began to write; in ascending order, and only those that
    // have points. Errors: truncated, corrupt.
    Status decode(int stratum, ByteReader& from);
    // Of the stratum decoded last; as neighbourChoices() tells them.
    NeighbourChoices choices() const { return choices_; }
    // The coordinates of every decoded point, in progressive order. Errors: corrupt, if one lies outside
    // the extent that the layout states.
    Result<std::vector<Vec3<std::uint32_t>>> takePositions();

  private:
    Status decodeFirst(BitReader& bits, std::span<const std::uint8_t> tokens);
    Status decodeBetween(int stratum, BitReader& bits, std::span<const std::uint8_t> tokens,
                         std::size_t tokenCount);
    Status decodeLows(int stratum, BitReader& bits);
    template <bool hasLows>
    Result<bool> place(int stratum, const BitPermutation& toPacked, std::span<Vec3<std::uint32_t>> to) const;

    const WorkGate* gate_;
    std::uint32_t pointCount_;
    int nodeBits_, strata_;
    int decoded_ = 0;
    std::uint32_t spacing_; // Morton indices between neighbours in keys_
    KeyLayout layout_;
    std::vector<std::uint64_t> keys_, lows_; // in Morton order
    std::vector<NeighbourChoice> choices_;
};

} // namespace stipple
