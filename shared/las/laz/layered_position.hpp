// The first layer of a chunk: scanner channel, return number, number of returns, X and Y of each point, and
// which of its other values changed. It is the one that all others need.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/las/laz/coding.hpp"
#include "shared/las/laz/layered_layer.hpp"
#include "shared/las/laz/streaming_median.hpp"

#include <algorithm>

namespace stipple::las::laz {

// The kind of return, by number of returns (row) and return number (column): 0 single, 1 and 2 first and last
// of two, 3 first, 4 between, 5 last of many; the format gives the impossible pairs a kind, too.
inline constexpr char returnKinds[16][17] = {
    "0123453445555555", "1013333333333333", "2124444444433333", "3345444444444444",
    "4344544444444444", "5344454444444444", "3344445444444444", "4344444544444444",
    "4344444454444444", "5344444445444444", "5344444444544444", "5334444444455444",
    "5334444444455544", "5334444444445554", "5334444444444555", "5334444444444455",
};

inline unsigned returnLevel(unsigned count, unsigned number) {
    return std::min(count > number ? count - number : number - count, 7u);
}

inline unsigned evenUpTo(unsigned bits, unsigned most) {
    return bits < most ? bits & ~1u : most;
}

class PositionLayer {
  public:
    static constexpr std::size_t maxBytes = 24;
    static constexpr std::size_t returnsOffsetBytes = 14, flagsOffsetBytes = 15;

    static unsigned channelOf(const std::uint8_t* record) { return record[flagsOffsetBytes] >> 4 & 3; }

    void start(const std::uint8_t* record);

    // Sets the info of the point. Of byte 15, reading sets the scanner channel's bits.
    template <class Stream>
    void codePoint(Stream& stream, PointInfo& info, typename Stream::Byte* record);

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
        std::array<StreamingMedian5, 12> xSteps, ySteps;
        IntegerCompressor<32, 2> xs;
        IntegerCompressor<32, 22> ys;

        void begin(const Last& last);
    };
    // Bits of the symbol of what changed; the lowest two are about the return number.
    static constexpr unsigned returnCountChange = 4, valueShift = 3, channelChange = 64;

    static Last load(const std::uint8_t* record);
    static unsigned changesOf(const Last& now, const Last& last);

    Channels<State, Last> channels_;
    unsigned channel_ = 0;  // of the last point
    unsigned lastKind_ = 0; // of the last point: first 1, last 2, GPS time changed 4
};

template <class Stream>
STIPPLE_LAZ_INLINE void PositionLayer::codePoint(Stream& stream, PointInfo& info,
                                                 typename Stream::Byte* record) {
    unsigned changes = 0, channel = channel_;
    Last now;
    if constexpr (Stream::writing) {
        now = load(record);
        channel = channelOf(record);
        changes = changesOf(now, channels_.lastFor(channel)) | (channel != channel_ ? channelChange : 0);
    }
    // What changed is coded with the state of the channel before.
    State& before = channels_.choose(channel_).state;
    changes = stream.symbol(before.changes[lastKind_], changes);
    const bool otherChannel = changes & channelChange;
    if (otherChannel)
        channel_ = (channel_ + 1 + stream.symbol(before.otherChannel, (channel - channel_ - 1) & 3)) & 3;
    auto [state, last] = channels_.choose(channel_);

    unsigned count = last.returnCount, number = last.returnNumber;
    if (changes & returnCountChange)
        count = stream.symbol(state.returnCounts[count], now.returnCount);
    const bool timeChanged = changes & PointInfo::gpsTimeChange << valueShift;
    if ((changes & 3) == 3)
        number =
            timeChanged
                ? stream.symbol(state.returnNumbers[number], now.returnNumber)
                : (number + 2 + stream.symbol(state.returnSteps, (now.returnNumber - number - 2) & 15)) & 15;
    else
        number = (number + (changes & 1) - (changes >> 1 & 1)) & 15;

    const unsigned single = count == 1;
    const unsigned kind = static_cast<unsigned>(returnKinds[count][number] - '0') << 1 | timeChanged;
    const auto xStep =
        stream.integer(state.xs, state.xSteps[kind].get(), wrapSubtract(now.x, last.x), single);
    state.xSteps[kind].add(xStep);
    const unsigned xBits = state.xs.k();
    const auto yStep = stream.integer(state.ys, state.ySteps[kind].get(), wrapSubtract(now.y, last.y),
                                      single + evenUpTo(xBits, 20));
    state.ySteps[kind].add(yStep);
    const unsigned yBits = state.ys.k();

    if constexpr (Stream::writing) {
        last = now;
    } else {
        last.x = wrapAdd(last.x, xStep);
        last.y = wrapAdd(last.y, yStep);
        last.returnNumber = number;
        last.returnCount = count;
        storeLe(record, last.x);
        storeLe(record + 4, last.y);
        record[returnsOffsetBytes] = static_cast<std::uint8_t>(count << 4 | number);
        record[flagsOffsetBytes] =
            static_cast<std::uint8_t>((record[flagsOffsetBytes] & 0xCF) | channel_ << 4);
    }
    const bool first = number == 1, final = number >= count;
    lastKind_ = (first ? 1u : 0u) | (final ? 2u : 0u) | (timeChanged ? 4u : 0u);
    info = PointInfo(channel_, otherChannel, changes >> valueShift & 7, (first ? 2u : 0u) | (final ? 1u : 0u),
                     returnLevel(count, number), single + evenUpTo((xBits + yBits) / 2, 18));
}

} // namespace stipple::las::laz
