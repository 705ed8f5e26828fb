// Decodes what ArithmeticEncoder wrote (FastAC with LASzip's constants; see arithmetic_model.hpp).
//
// A small value: a hot loop copies it into a local, so that its state stays in registers, and writes it back.
// No call checks the end of the bytes. A call reads at most maxBytesPerCall bytes and up to 4 beyond;
// whoever loops makes sure of so much room behind the end (zeros will do), and compares position() with the
// end once a record: a position beyond it means the stream was damaged. Whatever the bytes are,
// symbols are within their model, and the state stays sound.
#pragma once

#include "shared/las/laz/arithmetic_model.hpp"

#include <cstring>

namespace stipple::las::laz {

class ArithmeticDecoder {
  public:
    static constexpr std::size_t maxBytesPerCall = 4; // readInt(); a symbol takes 2
    static constexpr std::size_t startBytes = 4;

    ArithmeticDecoder() = default;
    // Reads the first 4 bytes.
    explicit ArithmeticDecoder(const std::uint8_t* at) : at_(at + startBytes), value_(loadBigEndian(at)) {
        // value < length holds from here on for any bytes; no encoder writes this one.
        if (value_ == length_)
            --value_;
    }

    // Behind the last byte read: the stream's end once all is decoded.
    const std::uint8_t* position() const { return at_; }
    // Goes on at another place with the same bytes.
    void moveTo(const std::uint8_t* at) { at_ = at; }

    STIPPLE_LAZ_INLINE unsigned decodeBit(BitModel& model) {
        std::uint32_t split = model.zeroProbability * (length_ >> BitModel::precision);
        unsigned bit = value_ >= split;
        if (bit) {
            value_ -= split;
            length_ -= split;
        } else {
            length_ = split;
            ++model.zeroCount;
        }
        renormalize();
        if (--model.untilUpdate == 0)
            model.update();
        return bit;
    }

    template <unsigned Capacity, bool Fixed>
    STIPPLE_LAZ_INLINE unsigned decodeSymbol(AdaptiveModel<Capacity, Fixed>& model) {
        const std::uint32_t step = length_ >> AdaptiveModel<Capacity, Fixed>::precision;
        // A likely symbol is foreseen by the processor, which then does not wait for the division.
        unsigned symbol = model.likely;
        if (symbol == model.nothingLikely || !narrow(model, symbol, step)) {
            symbol = model.find(value_ / step);
            narrow(model, symbol, step);
            renormalize();
        } else if (length_ < minIntervalLength) { // never by more than a byte: half of the interval is left
            value_ = value_ << 8 | *at_++;
            length_ <<= 8;
        }
        ++model.count[symbol];
        if (--model.untilUpdate == 0)
            model.template update<true>();
        return symbol;
    }

    // `count` bits (1 … 32) of equal probability. Damaged streams may give a larger number.
    STIPPLE_LAZ_INLINE std::uint32_t readBits(unsigned count) {
        if (count > 19) {
            std::uint32_t low = readPart(16);
            return (readPart(count - 16) << 16) | low;
        }
        return readPart(count);
    }
    STIPPLE_LAZ_INLINE std::uint32_t readInt() {
        std::uint32_t low = readPart(16);
        return (readPart(16) << 16) | low;
    }
    STIPPLE_LAZ_INLINE std::uint64_t readInt64() {
        std::uint64_t low = readInt();
        return (static_cast<std::uint64_t>(readInt()) << 32) | low;
    }

  private:
    static STIPPLE_LAZ_INLINE std::uint32_t loadBigEndian(const std::uint8_t* from) {
        std::uint32_t value;
        std::memcpy(&value, from, sizeof value);
        return __builtin_bswap32(value);
    }

    // Makes the interval the symbol's part of it, if the value is there.
    template <class Model>
    STIPPLE_LAZ_INLINE bool narrow(const Model& model, unsigned symbol, std::uint32_t step) {
        const std::uint32_t low = model.distribution[symbol] * step;
        const std::uint32_t high =
            symbol + 1 == model.symbols() ? length_ : model.distribution[symbol + 1] * step;
        if (value_ - low >= high - low)
            return false;
        value_ -= low;
        length_ = high - low;
        return true;
    }

    STIPPLE_LAZ_INLINE std::uint32_t readPart(unsigned count) {
        length_ >>= count;
        std::uint32_t bits = value_ / length_;
        value_ -= length_ * bits;
        renormalize();
        return bits;
    }

    // Takes in the bytes that bring the length to 2^24 or above again.
    STIPPLE_LAZ_INLINE void renormalize() {
        const unsigned bytes = static_cast<unsigned>(__builtin_clz(length_)) >> 3;
        const unsigned bits = 8 * bytes;
        const std::uint64_t wide = (static_cast<std::uint64_t>(value_) << 32) | loadBigEndian(at_);
        value_ = static_cast<std::uint32_t>((wide << bits) >> 32);
        length_ <<= bits;
        at_ += bytes;
    }

    const std::uint8_t* at_ = nullptr;
    std::uint32_t value_ = 0, length_ = 0xFFFFFFFFu;
};

} // namespace stipple::las::laz
