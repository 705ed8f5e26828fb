// The colour that travels with a node's positions, stratum by stratum (docs/FORMAT.md, "Colour"): red,
// green, blue, or one intensity. A value is predicted from the two neighbours in Morton order that
// bracket its position: by their mean, or by one of them alone if that is much nearer.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"
#include "shared/base/work_gate.hpp"
#include "shared/codec/neighbour_choice.hpp"
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

ColourWidth narrowestWidth(std::span<const std::uint16_t> values);
// To the nearest values that are stored in `width`.
void roundTo(ColourWidth width, std::span<std::uint16_t> values);

// Writes one stratum. `values` are those of all the node's points in Morton order, `channels` (1 or 3)
// interleaved; `choices` those of the stratum (ignored for stratum 0).
void encodeColour(ByteWriter& to, std::span<const std::uint16_t> values, int channels, ColourWidth width,
                  int stratum, NeighbourChoices choices);

// Decodes strata one after the other.
class ColourDecoder {
  public:
    // For the first `strata` strata. Takes up to 32 bytes of memory a point; the caller has bounded their
    // number. Everything ends with `cancelled` once the gate is closed.
    ColourDecoder(std::uint32_t pointCount, int channels, int strata, const WorkGate* gate = nullptr);

    // Stratum `stratum`; in ascending order, and only those that have points. Errors: truncated, corrupt.
    Status decode(int stratum, ByteReader& from, NeighbourChoices choices);
    // The values of every decoded point in progressive order, interleaved.
    std::vector<std::uint16_t> takeValues() { return std::move(values_); }

  private:
    template <class Word>
    Status decodeAs(std::vector<Word>& known, int stratum, ByteReader& from, NeighbourChoices choices);
    template <class Word>
    Status predict(const std::vector<Word>& known, int stratum, NeighbourChoices choices,
                   std::vector<Word>& fresh) const;
    template <class Word>
    Status append(std::span<const Word> fresh);

    const WorkGate* gate_;
    std::uint32_t pointCount_;
    std::size_t channels_;
    ColourWidth width_ = ColourWidth::wide;
    // Decoded colours in Morton order, without those of later strata; all channels of a point in one word,
    // red or intensity in its lowest lane: lanes of 8 bits, or of 16 if the width is wide.
    std::vector<std::uint32_t> narrow_;
    std::vector<std::uint64_t> wide_;
    std::vector<std::uint16_t> values_;
};

} // namespace stipple
