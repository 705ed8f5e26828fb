// The item RGB12: the colours of formats 2, 3 and 5, byte by byte, versions 1 and 2.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/las/laz/coding.hpp"

namespace stipple::las::laz {

// The bits of the symbol that says which bytes changed: low and high of red, green and blue.
struct ColourBits {
    enum : unsigned { redLow = 1, redHigh = 2, greenLow = 4, greenHigh = 8, blueLow = 16, blueHigh = 32 };
    enum : unsigned { notGrey = 64 }; // version 2
};

struct Colour {
    // Low and high bytes in the order they lie in the record.
    std::array<std::uint8_t, 6> bytes{};

    static STIPPLE_LAZ_INLINE Colour load(const std::uint8_t* from) {
        Colour colour;
        std::memcpy(colour.bytes.data(), from, 6);
        return colour;
    }
    STIPPLE_LAZ_INLINE void store(std::uint8_t* to) const { std::memcpy(to, bytes.data(), 6); }

    // Bit i: byte i differs.
    STIPPLE_LAZ_INLINE unsigned changes(const Colour& last) const {
        unsigned changed = 0;
        for (unsigned i = 0; i < 6; ++i)
            changed |= (bytes[i] != last.bytes[i] ? 1u : 0u) << i;
        return changed;
    }
    STIPPLE_LAZ_INLINE bool isGrey() const {
        return bytes[0] == bytes[2] && bytes[0] == bytes[4] && bytes[1] == bytes[3] && bytes[1] == bytes[5];
    }
};

class Rgb12V2 {
  public:
    static constexpr std::size_t size = 6;
    static constexpr std::size_t maxBytes = 16;

    void start(const std::uint8_t* first) {
        last_ = Colour::load(first);
        changed_.init();
        for (auto& model : bytes_)
            model.init();
    }

    template <class Coder, class Byte>
    Coder code(Coder coder, Byte* record) {
        Colour colour = last_;
        unsigned changed = 0;
        if constexpr (encodes<Coder>) {
            colour = Colour::load(record);
            changed = colour.changes(last_) | (colour.isGrey() ? 0u : ColourBits::notGrey);
        }
        changed = codeSymbol(coder, changed_, changed);
        auto& c = colour.bytes;
        const auto& last = last_.bytes;
        if (changed & ColourBits::redLow)
            c[0] = codeByte(coder, bytes_[0], last[0], c[0]);
        if (changed & ColourBits::redHigh)
            c[1] = codeByte(coder, bytes_[1], last[1], c[1]);
        if (changed & ColourBits::notGrey) {
            codeLike(coder, changed, 0, colour);
            codeLike(coder, changed, 1, colour);
        } else {
            c[2] = c[4] = c[0];
            c[3] = c[5] = c[1];
        }
        last_ = colour;
        if constexpr (!encodes<Coder>)
            colour.store(record);
        return coder;
    }

  private:
    // Green changes as red did; blue as the mean of both. Of the low (0) or the high bytes (1).
    template <class Coder>
    STIPPLE_LAZ_INLINE void codeLike(Coder& coder, unsigned changed, std::size_t half, Colour& colour) {
        auto& c = colour.bytes;
        const auto& last = last_.bytes;
        const std::size_t red = half, green = 2 + half, blue = 4 + half;
        int change = c[red] - last[red];
        if (changed & (ColourBits::greenLow << half))
            c[green] = codeByte(coder, bytes_[green], clamped(change + last[green]), c[green]);
        if (changed & (ColourBits::blueLow << half)) {
            change = (change + c[green] - last[green]) / 2;
            c[blue] = codeByte(coder, bytes_[blue], clamped(change + last[blue]), c[blue]);
        }
    }
    static STIPPLE_LAZ_INLINE unsigned clamped(int value) {
        return static_cast<unsigned>(value < 0 ? 0 : value > 255 ? 255 : value);
    }

    Colour last_;
    SymbolModel<128> changed_;
    std::array<SymbolModel<256>, 6> bytes_;
};

// Version 1 (LASzip 1.x).
class Rgb12V1 {
  public:
    static constexpr std::size_t size = 6;
    static constexpr std::size_t maxBytes = 56;

    void start(const std::uint8_t* first) {
        last_ = Colour::load(first);
        changed_.init();
        bytes_.init();
    }

    template <class Coder, class Byte>
    Coder code(Coder coder, Byte* record) {
        Colour colour = last_;
        if constexpr (encodes<Coder>)
            colour = Colour::load(record);
        unsigned changed = codeSymbol(coder, changed_, colour.changes(last_));
        for (unsigned i = 0; i < 6; ++i)
            if (changed & (1u << i))
                colour.bytes[i] =
                    static_cast<std::uint8_t>(codeInteger(coder, bytes_, last_.bytes[i], colour.bytes[i], i));
        last_ = colour;
        if constexpr (!encodes<Coder>)
            colour.store(record);
        return coder;
    }

  private:
    Colour last_;
    SymbolModel<64> changed_;
    IntegerCompressor<8, 6> bytes_;
};

} // namespace stipple::las::laz
