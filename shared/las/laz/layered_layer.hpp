// What the layers of a layered chunk (LASzip compressor 3, point formats 6-10) have in common: a reader and a
// writer with the same calls, so that one description of a layer serves both directions; what a layer must
// know of each point; and a state for each scanner channel.
#pragma once

#include "shared/las/laz/integer_compressor.hpp"

#include <memory>

namespace stipple::las::laz {

// One layer's stream, read. The value that each call is given is the one to write: ignored here.
struct LayerReader {
    static constexpr bool writing = false;
    using Byte = std::uint8_t;

    ArithmeticDecoder coder;
    const std::uint8_t* end = nullptr;

    template <class Model>
    STIPPLE_LAZ_INLINE unsigned symbol(Model& model, unsigned) {
        return coder.decodeSymbol(model);
    }
    template <class Compressor>
    STIPPLE_LAZ_INLINE std::int32_t integer(Compressor& compressor, std::int32_t predicted, std::int32_t,
                                            unsigned context = 0) {
        return compressor.decompress(coder, predicted, context);
    }
    STIPPLE_LAZ_INLINE std::uint32_t word(std::uint32_t) { return coder.readInt(); }
    STIPPLE_LAZ_INLINE std::uint64_t longWord(std::uint64_t) { return coder.readInt64(); }
    // The layer's bytes were not enough: it is damaged. Asked once a point, so reads pass the end by the most
    // that a point may take (maxBytes of each layer).
    STIPPLE_LAZ_INLINE bool pastEnd() const { return coder.position() > end; }
};

// One layer's stream, written; calls give back the value.
struct LayerWriter {
    static constexpr bool writing = true;
    using Byte = const std::uint8_t;

    ArithmeticEncoder coder;

    template <class Model>
    STIPPLE_LAZ_INLINE unsigned symbol(Model& model, unsigned value) {
        coder.encodeSymbol(model, value);
        return value;
    }
    template <class Compressor>
    STIPPLE_LAZ_INLINE std::int32_t integer(Compressor& compressor, std::int32_t predicted,
                                            std::int32_t value, unsigned context = 0) {
        compressor.compress(coder, predicted, value, context);
        return value;
    }
    STIPPLE_LAZ_INLINE std::uint32_t word(std::uint32_t value) {
        coder.writeInt(value);
        return value;
    }
    STIPPLE_LAZ_INLINE std::uint64_t longWord(std::uint64_t value) {
        coder.writeInt64(value);
        return value;
    }
    STIPPLE_LAZ_INLINE bool pastEnd() const { return false; }
};

// What the first layer learns of a point and the others predict with.
class PointInfo {
  public:
    PointInfo() = default;
    PointInfo(unsigned channel, bool otherChannel, unsigned changes, unsigned returns, unsigned level,
              unsigned heightContext)
        : bits_(static_cast<std::uint16_t>(channel | otherChannel << 2 | changes << 3 | returns << 6 |
                                           level << 8 | heightContext << 11)) {}

    // Bits of `changes`: what differs from the last point of the same channel.
    static constexpr unsigned scanAngleChange = 1, gpsTimeChange = 2, pointSourceChange = 4;

    unsigned channel() const { return bits_ & 3; }
    bool otherChannel() const { return bits_ & 4; } // than the point before
    bool scanAngleChanged() const { return bits_ & scanAngleChange << 3; }
    bool gpsTimeChanged() const { return bits_ & gpsTimeChange << 3; }
    bool pointSourceChanged() const { return bits_ & pointSourceChange << 3; }
    // 3: the only return, 2: first, 1: last, 0: between.
    unsigned returns() const { return bits_ >> 6 & 3; }
    // Returns to come, 0..7.
    unsigned level() const { return bits_ >> 8 & 7; }
    // 0..19, by how well X and Y were predicted, and odd for single returns.
    unsigned heightContext() const { return bits_ >> 11; }

  private:
    std::uint16_t bits_ = 0;
};

// Some points that lie one after another in memory.
template <class Byte>
struct PointRun {
    Byte* records = nullptr;
    std::size_t recordLength = 0;
    std::size_t count = 0;
    PointInfo* infos = nullptr;
};

// The state of one layer for each scanner channel, made when its first point comes. State::begin(last)
// sets it to its start after a point of value `last`.
template <class State, class Value>
class Channels {
  public:
    struct Choice {
        State& state;
        Value& last; // what is predicted from, and then replaced
    };

    // A chunk whose first point has this value. `refreshes`, `follows`: see chooseForItem().
    void start(unsigned channel, const Value& value, bool refreshes = true, bool follows = true) {
        used_ = 0;
        current_ = channel;
        refreshes_ = refreshes;
        follows_ = follows;
        last_[current_] = value;
        make(current_);
    }

    // The state of a channel and the last value there; a new channel starts with the value of the point
    // before.
    STIPPLE_LAZ_INLINE Choice choose(unsigned channel) {
        if (channel != current_) [[unlikely]]
            switchTo(channel);
        return {*states_[current_], last_[current_]};
    }
    // The last value that choose() would give.
    const Value& lastFor(unsigned channel) const { return last_[used_ >> channel & 1 ? channel : current_]; }

    // For the items behind POINT14. Version 4 does the same as above. Version 3 has two errors that are now
    // its format: a point is given to channel 0 unless its channel differs from that of the point before (not
    // `follows`); and the first point of a channel that was there before is predicted from the value of the
    // channel before it, and replaces that (not `refreshes`).
    STIPPLE_LAZ_INLINE Choice chooseForItem(PointInfo point) {
        unsigned channel = follows_ || point.otherChannel() ? point.channel() : 0;
        unsigned last = current_;
        if (channel != current_) [[unlikely]] {
            if (!(used_ >> channel & 1) || refreshes_)
                last = channel;
            switchTo(channel);
        }
        return {*states_[current_], last_[last]};
    }

  private:
    STIPPLE_LAZ_COLD void switchTo(unsigned channel) {
        if (!(used_ >> channel & 1)) {
            last_[channel] = last_[current_];
            make(channel);
        }
        current_ = channel;
    }

    void make(unsigned channel) {
        used_ |= 1u << channel;
        if (!states_[channel])
            states_[channel] = std::make_unique<State>();
        states_[channel]->begin(last_[channel]);
    }

    std::array<std::unique_ptr<State>, 4> states_;
    std::array<Value, 4> last_{};
    unsigned used_ = 0, current_ = 0;
    bool refreshes_ = true, follows_ = true;
};

// Codes the points of a run in one layer, until its stream ends early. The stream is copied meanwhile, so
// that its state stays in registers. Layer::codePoint(stream, info, record) codes a point: the first layer
// sets its info, the others read it.
template <class Stream, class Layer>
void codeRun(Stream& stream, Layer& layer, const PointRun<typename Stream::Byte>& run) {
    Stream local = stream;
    auto* record = run.records;
    for (std::size_t i = 0; i < run.count; ++i, record += run.recordLength) {
        layer.codePoint(local, run.infos[i], record);
        if (local.pastEnd()) [[unlikely]]
            break;
    }
    stream = local;
}

} // namespace stipple::las::laz
