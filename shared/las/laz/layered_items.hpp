// The layers of the items behind POINT14: RGB and near infrared, wave packets, extra bytes.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/las/laz/layered_layer.hpp"

namespace stipple::las::laz {

// Where an item lies in the record, and how it follows the scanner channels: Channels::chooseForItem().
struct ItemPlace {
    std::size_t offsetBytes = 0;
    std::size_t sizeBytes = 0; // 0: the format has none
    bool refreshes = true, follows = true;
};

inline unsigned clampToByte(int value) {
    return static_cast<unsigned>(value < 0 ? 0 : value > 255 ? 255 : value);
}

// Red, green and blue, 16 bits each, byte by byte: a symbol says which of the six differ from the last
// point's, and whether the colour is grey (bit 6 clear). Red is predicted from the last point, green and blue
// from the last point and the change of the channels before.
class ColourLayer {
  public:
    static constexpr std::size_t maxBytes = 14;
    void place(const ItemPlace& place) { place_ = place; }
    void start(unsigned channel, const std::uint8_t* record) {
        channels_.start(channel, load(record + place_.offsetBytes), place_.refreshes, place_.follows);
    }

    template <class Stream>
    STIPPLE_LAZ_INLINE void codePoint(Stream& stream, PointInfo point, typename Stream::Byte* record) {
        auto [state, last] = channels_.chooseForItem(point);
        Colour now{};
        if constexpr (Stream::writing)
            now = load(record + place_.offsetBytes);
        last = codeColour(stream, state, last, now);
        if constexpr (!Stream::writing)
            for (unsigned c = 0; c < 3; ++c)
                storeLe(record + place_.offsetBytes + 2 * c, last[c]);
    }

  private:
    using Colour = std::array<std::uint16_t, 3>;
    struct State {
        SymbolModel<128> changes;
        std::array<SymbolModel<256>, 6> bytes; // red low, high, green low, high, blue low, high

        void begin(const Colour&) {
            changes.init();
            for (auto& model : bytes)
                model.init();
        }
    };
    static constexpr unsigned notGrey = 64;

    static Colour load(const std::uint8_t* field) {
        return {loadLe<std::uint16_t>(field), loadLe<std::uint16_t>(field + 2),
                loadLe<std::uint16_t>(field + 4)};
    }

    static unsigned changesOf(const Colour& last, const Colour& now) {
        unsigned changes = now[1] != now[0] || now[2] != now[0] ? notGrey : 0;
        for (unsigned c = 0; c < 3; ++c) {
            const unsigned differing = last[c] ^ now[c];
            changes |= (differing & 0x00FF ? 1u : 0u) << (2 * c) | (differing & 0xFF00 ? 2u : 0u) << (2 * c);
        }
        return changes;
    }

    // A byte as its difference from a prediction, modulo 256.
    template <class Stream>
    static STIPPLE_LAZ_INLINE int codeByte(Stream& stream, SymbolModel<256>& model, unsigned predicted,
                                           unsigned now) {
        return static_cast<int>((predicted + stream.symbol(model, (now - predicted) & 255)) & 255);
    }

    template <class Stream>
    static STIPPLE_LAZ_INLINE Colour codeColour(Stream& stream, State& state, const Colour& last,
                                                const Colour& now) {
        unsigned changes = 0;
        if constexpr (Stream::writing)
            changes = changesOf(last, now);
        changes = stream.symbol(state.changes, changes);

        std::array<int, 6> before, value; // of the bytes, in the order of State::bytes
        for (unsigned b = 0; b < 6; ++b)
            before[b] = value[b] = last[b / 2] >> (b % 2 * 8) & 255;
        auto code = [&](unsigned b, unsigned predicted) {
            value[b] = codeByte(stream, state.bytes[b], predicted, now[b / 2] >> (b % 2 * 8) & 255u);
        };
        for (unsigned b = 0; b < 2; ++b)
            if (changes & 1u << b)
                code(b, static_cast<unsigned>(before[b]));
        if (!(changes & notGrey)) {
            const auto grey = static_cast<std::uint16_t>(value[0] | value[1] << 8);
            return {grey, grey, grey};
        }
        for (unsigned b = 0; b < 2; ++b) { // low bytes, then high bytes
            const unsigned green = b + 2, blue = b + 4;
            int step = value[b] - before[b];
            if (changes & 1u << green)
                code(green, clampToByte(step + before[green]));
            if (changes & 1u << blue) {
                step = (step + value[green] - before[green]) / 2;
                code(blue, clampToByte(step + before[blue]));
            }
        }
        auto word = [&](unsigned c) {
            return static_cast<std::uint16_t>(value[2 * c] | value[2 * c + 1] << 8);
        };
        return {word(0), word(1), word(2)};
    }

    Channels<State, Colour> channels_;
    ItemPlace place_;
};

// Near infrared, as colours are, but alone.
class InfraredLayer {
  public:
    static constexpr std::size_t maxBytes = 6;
    void place(const ItemPlace& place) { place_ = place; }
    void start(unsigned channel, const std::uint8_t* record) {
        channels_.start(channel, loadLe<std::uint16_t>(record + place_.offsetBytes), place_.refreshes,
                        place_.follows);
    }

    template <class Stream>
    STIPPLE_LAZ_INLINE void codePoint(Stream& stream, PointInfo point, typename Stream::Byte* record) {
        auto [state, last] = channels_.chooseForItem(point);
        unsigned now = 0, changes = 0;
        if constexpr (Stream::writing) {
            now = loadLe<std::uint16_t>(record + place_.offsetBytes);
            changes = ((now ^ last) & 0x00FF ? 1u : 0u) | ((now ^ last) & 0xFF00 ? 2u : 0u);
        }
        changes = stream.symbol(state.changes, changes);
        unsigned low = last & 255u, high = last >> 8;
        if (changes & 1)
            low = (low + stream.symbol(state.low, (now - low) & 255)) & 255;
        if (changes & 2)
            high = (high + stream.symbol(state.high, ((now >> 8) - high) & 255)) & 255;
        last = static_cast<std::uint16_t>(high << 8 | low);
        if constexpr (!Stream::writing)
            storeLe(record + place_.offsetBytes, last);
    }

  private:
    struct State {
        SymbolModel<4> changes;
        SymbolModel<256> low, high;

        void begin(std::uint16_t) {
            changes.init();
            low.init();
            high.init();
        }
    };
    Channels<State, std::uint16_t> channels_;
    ItemPlace place_;
};

// Where a point's waveform lies: descriptor, offset, size, then the return's place and the direction of its
// line, floats coded as integers.
class WavePacketLayer {
  public:
    static constexpr std::size_t maxBytes = 52;
    static constexpr std::size_t sizeBytes = 29;

    void place(const ItemPlace& place) { place_ = place; }
    void start(unsigned channel, const std::uint8_t* record) {
        channels_.start(channel, load(record + place_.offsetBytes), place_.refreshes, place_.follows);
    }

    template <class Stream>
    STIPPLE_LAZ_INLINE void codePoint(Stream& stream, PointInfo point, typename Stream::Byte* record) {
        auto [state, last] = channels_.chooseForItem(point);
        Packet now{};
        if constexpr (Stream::writing)
            now = load(record + place_.offsetBytes);
        last = codePacket(stream, state, last, now);
        if constexpr (!Stream::writing)
            store(record + place_.offsetBytes, last);
    }

  private:
    struct Packet {
        std::uint8_t descriptor = 0;
        std::uint64_t offset = 0;
        std::int32_t size = 0, place = 0;
        std::array<std::int32_t, 3> direction{};
    };
    // How an offset follows from the last one.
    enum Step : unsigned { same = 0, behindLast = 1, near = 2, far = 3 };
    struct State {
        SymbolModel<256> descriptors;
        std::array<SymbolModel<4>, 4> steps; // by the last step
        IntegerCompressor<32> offsets, sizes, places;
        IntegerCompressor<32, 3> directions;
        unsigned lastStep = 0;
        std::int32_t lastDifference = 0;

        void begin(const Packet&) {
            descriptors.init();
            for (auto& model : steps)
                model.init();
            offsets.init();
            sizes.init();
            places.init();
            directions.init();
            lastStep = 0;
            lastDifference = 0;
        }
    };

    static Packet load(const std::uint8_t* field) {
        Packet packet;
        packet.descriptor = field[0];
        packet.offset = loadLe<std::uint64_t>(field + 1);
        packet.size = loadLe<std::int32_t>(field + 9);
        packet.place = loadLe<std::int32_t>(field + 13);
        for (unsigned c = 0; c < 3; ++c)
            packet.direction[c] = loadLe<std::int32_t>(field + 17 + 4 * c);
        return packet;
    }

    static void store(std::uint8_t* field, const Packet& packet) {
        field[0] = packet.descriptor;
        storeLe(field + 1, packet.offset);
        storeLe(field + 9, packet.size);
        storeLe(field + 13, packet.place);
        for (unsigned c = 0; c < 3; ++c)
            storeLe(field + 17 + 4 * c, packet.direction[c]);
    }

    static unsigned stepOf(const Packet& last, const Packet& now) {
        const auto difference = static_cast<std::int64_t>(now.offset - last.offset);
        if (difference != static_cast<std::int32_t>(difference))
            return far;
        return difference == 0 ? same : difference == last.size && last.size > 0 ? behindLast : near;
    }

    template <class Stream>
    static STIPPLE_LAZ_INLINE Packet codePacket(Stream& stream, State& state, const Packet& last,
                                                const Packet& now) {
        Packet packet;
        packet.descriptor = static_cast<std::uint8_t>(stream.symbol(state.descriptors, now.descriptor));
        state.lastStep = stream.symbol(state.steps[state.lastStep], stepOf(last, now));
        switch (state.lastStep) {
        case same:
            packet.offset = last.offset;
            break;
        case behindLast:
            packet.offset = last.offset + static_cast<std::uint32_t>(last.size);
            break;
        case near:
            state.lastDifference = stream.integer(state.offsets, state.lastDifference,
                                                  static_cast<std::int32_t>(now.offset - last.offset));
            packet.offset = last.offset + static_cast<std::uint64_t>(std::int64_t{state.lastDifference});
            break;
        default:
            packet.offset = stream.longWord(now.offset);
        }
        packet.size = stream.integer(state.sizes, last.size, now.size);
        packet.place = stream.integer(state.places, last.place, now.place);
        for (unsigned c = 0; c < 3; ++c)
            packet.direction[c] = stream.integer(state.directions, last.direction[c], now.direction[c], c);
        return packet;
    }

    Channels<State, Packet> channels_;
    ItemPlace place_;
};

// One of the extra bytes: its difference from the last one, modulo 256.
class ExtraByteLayer {
  public:
    static constexpr std::size_t maxBytes = 2;
    void place(const ItemPlace& place) { place_ = place; }
    void start(unsigned channel, const std::uint8_t* record) {
        channels_.start(channel, record[place_.offsetBytes], place_.refreshes, place_.follows);
    }

    template <class Stream>
    STIPPLE_LAZ_INLINE void codePoint(Stream& stream, PointInfo point, typename Stream::Byte* record) {
        auto [state, last] = channels_.chooseForItem(point);
        unsigned difference = 0;
        if constexpr (Stream::writing)
            difference = (record[place_.offsetBytes] - last) & 255u;
        last = static_cast<std::uint8_t>(last + stream.symbol(state.differences, difference));
        if constexpr (!Stream::writing)
            record[place_.offsetBytes] = last;
    }

  private:
    struct State {
        SymbolModel<256> differences;
        void begin(std::uint8_t) { differences.init(); }
    };
    Channels<State, std::uint8_t> channels_;
    ItemPlace place_;
};

} // namespace stipple::las::laz
