// The first layer of a chunk: scanner channel, return number, number of returns, X and Y of each point, and
// which of its other values changed. It is the one that all others need.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/las/laz/layered_layer.hpp"

#include <algorithm>

namespace stipple::las::laz {

// The median of the last five values, nearly: a new value replaces the highest or the lowest, in turns as
// values fall below and above the middle.
class StreamingMedian {
  public:
    std::int32_t get() const { return sorted_[2]; }

    STIPPLE_LAZ_INLINE void add(std::int32_t value) {
        const std::int32_t* kept = sorted_.data() + !dropHighest_;
        const std::int32_t a = kept[0], b = kept[1], c = kept[2], d = kept[3];
        dropHighest_ = dropHighest_ ? value < sorted_[2] : value <= sorted_[2];
        sorted_ = {std::min(a, value), std::max(a, std::min(b, value)), std::max(b, std::min(c, value)),
                   std::max(c, std::min(d, value)), std::max(d, value)};
    }

  private:
    std::array<std::int32_t, 5> sorted_{};
    bool dropHighest_ = true;
};

class PositionLayer {
  public:
    static constexpr std::size_t maxBytes = 24;
    static constexpr std::size_t returnsOffsetBytes = 14, flagsOffsetBytes = 15;

    static unsigned channelOf(const std::uint8_t* record) { return record[flagsOffsetBytes] >> 4 & 3; }

    void start(const std::uint8_t* record);

    // Codes a run and sets its infos. Of byte 15, reading sets the scanner channel's bits.
    template <class Stream>
    void code(Stream& stream, const PointRun<typename Stream::Byte>& run, PointInfo* infos);

  private:
    // What the points of a channel are predicted from. The last three: when writing only.
    struct Last {
        std::int32_t x = 0, y = 0;
        unsigned returnNumber = 0, returnCount = 0;
        std::uint16_t scanAngle = 0, pointSource = 0;
        std::uint64_t gpsTime = 0;
    };
    struct State {
        std::array<SymbolModel<128>, 8> changes;
        SymbolModel<3> otherChannel;
        LazyModels<SymbolModel<16>, 16> returnCounts, returnNumbers;
        SymbolModel<13> returnSteps;
        std::array<StreamingMedian, 12> xSteps, ySteps;
        IntegerCompressor<32, 2> xs;
        IntegerCompressor<32, 22> ys;

        void begin(const Last& last);
    };
    // Bits of the symbol of what changed; the lowest two are about the return number.
    static constexpr unsigned returnCountChange = 4, valueShift = 3, channelChange = 64;

    static Last load(const std::uint8_t* record);
    static unsigned changesOf(const Last& now, const Last& last);
    template <class Stream>
    PointInfo codePoint(Stream& stream, typename Stream::Byte* record);

    Channels<State, Last> channels_;
    unsigned channel_ = 0;  // of the last point
    unsigned lastKind_ = 0; // of the last point: first 1, last 2, GPS time changed 4
};

} // namespace stipple::las::laz
