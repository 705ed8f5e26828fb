// The colour that travels with a node's positions, stratum by stratum (docs/FORMAT.md, "Colour"): red,
// green, blue, or one intensity. A value is predicted from the same two neighbours in Morton order that
// bracket its position.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"
#include "shared/format/node_entry.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stipple {

// How the 16 bits of all values of a node are stored.
enum class ColourWidth : std::uint8_t {
    wide = 0,     // two bytes
    low = 1,      // value = byte
    high = 2,     // value = 256 × byte
    repeated = 3, // value = 257 × byte
};

// Values of a node's points in Morton order, `channels` (1 or 3) interleaved.
ColourWidth narrowestWidth(std::span<const std::uint16_t> values);
void encodeColour(ByteWriter& to, std::span<const std::uint16_t> values, std::uint32_t pointCount,
                  int channels, ColourWidth width, int stratum);

// Decodes strata one after the other.
class ColourDecoder {
  public:
    ColourDecoder(std::uint32_t pointCount, int channels, int strata);

    // Stratum `stratum`; in ascending order, and only those that have points. Errors: truncated, corrupt.
    Status decode(int stratum, ByteReader& from);
    // The values of every decoded point in progressive order, interleaved.
    void values(std::vector<std::uint16_t>& to) const;

  private:
    std::uint32_t pointCount_;
    int decoded_ = 0;
    ColourWidth width_ = ColourWidth::wide;
    std::uint32_t spacing_; // Morton indices between neighbours in planes_
    std::vector<std::vector<std::uint16_t>> planes_;
};

} // namespace stipple
