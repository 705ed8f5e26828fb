// The simple layers of POINT14: one value a point, predicted from the last one of its scanner channel.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/las/laz/layered_layer.hpp"

namespace stipple::las::laz {

// Z: from the last Z with as many returns to come.
class HeightLayer {
  public:
    static constexpr std::size_t maxBytes = 8;
    static constexpr std::size_t offsetBytes = 8;

    void start(unsigned channel, const std::uint8_t* record) {
        channels_.start(channel, loadLe<std::int32_t>(record + offsetBytes));
    }

    template <class Stream>
    STIPPLE_LAZ_INLINE void codePoint(Stream& stream, PointInfo point, typename Stream::Byte* record) {
        auto [state, last] = channels_.choose(point.channel());
        auto* field = record + offsetBytes;
        std::int32_t value = 0;
        if constexpr (Stream::writing)
            value = loadLe<std::int32_t>(field);
        std::int32_t& predicted = state.lastOfLevel[point.level()];
        value = stream.integer(state.heights, predicted, value, point.heightContext());
        predicted = last = value;
        if constexpr (!Stream::writing)
            storeLe(field, value);
    }

  private:
    struct State {
        IntegerCompressor<32, 20> heights;
        std::array<std::int32_t, 8> lastOfLevel;

        void begin(std::int32_t last) {
            heights.init();
            lastOfLevel.fill(last);
        }
    };
    Channels<State, std::int32_t> channels_;
};

// A byte by a model that the last byte, and for classes the kind of return, choose from 64.
template <class Format>
class SymbolLayer {
  public:
    static constexpr std::size_t maxBytes = 2;
    void start(unsigned channel, const std::uint8_t* record) {
        channels_.start(channel, Format::load(record));
    }

    template <class Stream>
    STIPPLE_LAZ_INLINE void codePoint(Stream& stream, PointInfo point, typename Stream::Byte* record) {
        auto [state, last] = channels_.choose(point.channel());
        unsigned value = 0;
        if constexpr (Stream::writing)
            value = Format::load(record);
        value = stream.symbol(state.models[Format::context(last, point)], value);
        last = static_cast<std::uint8_t>(value);
        if constexpr (!Stream::writing)
            Format::store(record, last);
    }

  private:
    struct State {
        LazyModels<SymbolModel<Format::symbols>, 64> models;
        void begin(std::uint8_t) { models.reset(); }
    };
    Channels<State, std::uint8_t> channels_;
};

struct ClassificationFormat {
    static constexpr unsigned symbols = 256;
    static constexpr std::size_t offsetBytes = 16;
    static unsigned context(std::uint8_t last, PointInfo point) {
        return (last & 31u) << 1 | (point.returns() == 3);
    }
    static std::uint8_t load(const std::uint8_t* record) { return record[offsetBytes]; }
    static void store(std::uint8_t* record, std::uint8_t value) { record[offsetBytes] = value; }
};

// The record's byte has edge of flight line, scan direction, 2 bits of scanner channel, 4 classification
// flags; the layer's value is the same without the channel, which the first layer stores.
struct FlagsFormat {
    static constexpr unsigned symbols = 64;
    static constexpr std::size_t offsetBytes = 15;
    static unsigned context(std::uint8_t last, PointInfo) { return last; }
    static std::uint8_t load(const std::uint8_t* record) {
        return static_cast<std::uint8_t>((record[offsetBytes] >> 2 & 0x30) | (record[offsetBytes] & 0x0F));
    }
    static void store(std::uint8_t* record, std::uint8_t value) {
        record[offsetBytes] =
            static_cast<std::uint8_t>((record[offsetBytes] & 0x30) | (value & 0x30) << 2 | (value & 0x0F));
    }
};

struct UserDataFormat {
    static constexpr unsigned symbols = 256;
    static constexpr std::size_t offsetBytes = 17;
    static unsigned context(std::uint8_t last, PointInfo) { return last >> 2; }
    static std::uint8_t load(const std::uint8_t* record) { return record[offsetBytes]; }
    static void store(std::uint8_t* record, std::uint8_t value) { record[offsetBytes] = value; }
};

using ClassificationLayer = SymbolLayer<ClassificationFormat>;
using FlagsLayer = SymbolLayer<FlagsFormat>;
using UserDataLayer = SymbolLayer<UserDataFormat>;

// From the last intensity of a return of the same kind, apart for points of the same GPS time as the last.
class IntensityLayer {
  public:
    static constexpr std::size_t maxBytes = 8;
    static constexpr std::size_t offsetBytes = 12;

    void start(unsigned channel, const std::uint8_t* record) {
        channels_.start(channel, loadLe<std::uint16_t>(record + offsetBytes));
    }

    template <class Stream>
    STIPPLE_LAZ_INLINE void codePoint(Stream& stream, PointInfo point, typename Stream::Byte* record) {
        auto [state, last] = channels_.choose(point.channel());
        auto* field = record + offsetBytes;
        std::int32_t value = 0;
        if constexpr (Stream::writing)
            value = loadLe<std::uint16_t>(field);
        std::uint16_t& predicted = state.lastOfKind[point.returns() << 1 | point.gpsTimeChanged()];
        value = stream.integer(state.intensities, predicted, value, point.returns());
        predicted = last = static_cast<std::uint16_t>(value);
        if constexpr (!Stream::writing)
            storeLe(field, last);
    }

  private:
    struct State {
        IntegerCompressor<16, 4> intensities;
        std::array<std::uint16_t, 8> lastOfKind;

        void begin(std::uint16_t last) {
            intensities.init();
            lastOfKind.fill(last);
        }
    };
    Channels<State, std::uint16_t> channels_;
};

// Scan angle and point source: only of the points where they changed, from the last one.
template <class Format>
class ChangeLayer {
  public:
    static constexpr std::size_t maxBytes = 8;
    using Value = typename Format::Value;

    void start(unsigned channel, const std::uint8_t* record) {
        channels_.start(channel, loadLe<Value>(record + Format::offsetBytes));
    }

    template <class Stream>
    STIPPLE_LAZ_INLINE void codePoint(Stream& stream, PointInfo point, typename Stream::Byte* record) {
        auto [state, last] = channels_.choose(point.channel());
        auto* field = record + Format::offsetBytes;
        if (Format::changed(point)) {
            std::int32_t value = 0;
            if constexpr (Stream::writing)
                value = loadLe<Value>(field);
            last = static_cast<Value>(stream.integer(state.values, last, value, Format::context(point)));
        }
        if constexpr (!Stream::writing)
            storeLe(field, last);
    }

  private:
    struct State {
        IntegerCompressor<16, Format::contexts> values;
        void begin(Value) { values.init(); }
    };
    Channels<State, Value> channels_;
};

struct ScanAngleFormat {
    using Value = std::int16_t;
    static constexpr std::size_t offsetBytes = 18;
    static constexpr unsigned contexts = 2;
    static bool changed(PointInfo point) { return point.scanAngleChanged(); }
    static unsigned context(PointInfo point) { return point.gpsTimeChanged(); }
};

struct PointSourceFormat {
    using Value = std::uint16_t;
    static constexpr std::size_t offsetBytes = 20;
    static constexpr unsigned contexts = 1;
    static bool changed(PointInfo point) { return point.pointSourceChanged(); }
    static unsigned context(PointInfo) { return 0; }
};

using ScanAngleLayer = ChangeLayer<ScanAngleFormat>;
using PointSourceLayer = ChangeLayer<PointSourceFormat>;

} // namespace stipple::las::laz
