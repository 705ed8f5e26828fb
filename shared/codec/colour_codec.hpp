// The colour that travels with a node's positions, stratum by stratum (docs/FORMAT.md, "Colour"): red,
// green, blue, or one intensity. A value is predicted from the two neighbours in Morton order that
// bracket its position: by their mean, or by one of them alone if that is much nearer.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"
#include "shared/codec/neighbour_choice.hpp"
#include "shared/format/node_entry.hpp"

#include <array>
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

ColourWidth narrowestWidth(std::span<const std::uint16_t> values);

// Writes one stratum. `values` are those of all the node's points in Morton order, `channels` (1 or 3)
// interleaved; `choices` those of the stratum (ignored for stratum 0).
void encodeColour(ByteWriter& to, std::span<const std::uint16_t> values, int channels, ColourWidth width,
                  int stratum, NeighbourChoices choices);

// Decodes strata one after the other.
class ColourDecoder {
  public:
    // For the first `strata` strata. Takes 8 bytes of memory a channel and point; the caller has bounded
    // their number.
    ColourDecoder(std::uint32_t pointCount, int channels, int strata);

    // Stratum `stratum`; in ascending order, and only those that have points. Errors: truncated, corrupt.
    Status decode(int stratum, ByteReader& from, NeighbourChoices choices);
    // The values of every decoded point in progressive order, interleaved.
    std::vector<std::uint16_t> takeValues() { return std::move(values_); }

  private:
    template <class T>
    Status decodeAs(std::array<std::vector<T>, 3>& known, int stratum, ByteReader& from,
                    NeighbourChoices choices);
    template <class T>
    void append(const std::array<std::vector<T>, 3>& fresh);

    std::uint32_t pointCount_;
    std::size_t channels_;
    ColourWidth width_ = ColourWidth::wide;
    // Decoded values of each channel in Morton order, without those of later strata.
    std::array<std::vector<std::uint8_t>, 3> bytes_;
    std::array<std::vector<std::uint16_t>, 3> words_;
    std::vector<std::uint16_t> values_;
};

} // namespace stipple
