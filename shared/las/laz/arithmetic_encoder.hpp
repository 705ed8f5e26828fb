// The arithmetic encoder of LAZ (FastAC with LASzip's constants; see arithmetic_model.hpp).
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/las/laz/arithmetic_model.hpp"

#include <algorithm>

namespace stipple::las::laz {

// A small value, as the decoder is: hot loops work on a local copy. It writes where it was told to, without
// looking for the end: at most maxBytesPerCall bytes a call. EncodedStream gives it room.
class ArithmeticEncoder {
  public:
    static constexpr std::size_t maxBytesPerCall = 4;

    ArithmeticEncoder() = default;
    explicit ArithmeticEncoder(std::uint8_t* at) : at_(at) {}

    std::uint8_t* position() const { return at_; }
    // Goes on at another place, behind a copy of all that was written.
    void moveTo(std::uint8_t* at) { at_ = at; }

    STIPPLE_LAZ_INLINE void encodeBit(BitModel& model, unsigned bit) {
        std::uint32_t split = model.zeroProbability * (length_ >> BitModel::precision);
        if (bit) {
            raiseBase(split);
            length_ -= split;
        } else {
            length_ = split;
            ++model.zeroCount;
        }
        renormalize();
        if (--model.untilUpdate == 0)
            model.update();
    }

    template <unsigned Capacity, bool Fixed>
    STIPPLE_LAZ_INLINE void encodeSymbol(AdaptiveModel<Capacity, Fixed>& model, unsigned symbol) {
        const std::uint32_t step = length_ >> AdaptiveModel<Capacity, Fixed>::precision;
        const std::uint32_t low = model.distribution[symbol] * step;
        const std::uint32_t high =
            symbol + 1 == model.symbols() ? length_ : model.distribution[symbol + 1] * step;
        raiseBase(low);
        length_ = high - low;
        renormalize();
        ++model.count[symbol];
        if (--model.untilUpdate == 0)
            model.template update<false>();
    }

    // The lowest `count` bits (1 … 32) of `bits`, which has no others.
    STIPPLE_LAZ_INLINE void writeBits(unsigned count, std::uint32_t bits) {
        if (count > 19) {
            writePart(16, bits & 0xFFFF);
            writePart(count - 16, bits >> 16);
        } else {
            writePart(count, bits);
        }
    }
    STIPPLE_LAZ_INLINE void writeInt(std::uint32_t value) {
        writePart(16, value & 0xFFFF);
        writePart(16, value >> 16);
    }
    STIPPLE_LAZ_INLINE void writeInt64(std::uint64_t value) {
        writeInt(static_cast<std::uint32_t>(value));
        writeInt(static_cast<std::uint32_t>(value >> 32));
    }

    // Closes the stream: 4 bytes, so that a decoder that reads 4 bytes ahead never passes its end.
    void finish() {
        bool oneMore = length_ > 2 * minIntervalLength;
        if (oneMore) {
            raiseBase(minIntervalLength);
            length_ = minIntervalLength >> 1;
        } else {
            raiseBase(minIntervalLength >> 1);
            length_ = minIntervalLength >> 9;
        }
        renormalize();
        *at_++ = 0;
        *at_++ = 0;
        if (oneMore)
            *at_++ = 0;
    }

  private:
    STIPPLE_LAZ_INLINE void writePart(unsigned count, std::uint32_t bits) {
        length_ >>= count;
        raiseBase(bits * length_);
        renormalize();
    }

    STIPPLE_LAZ_INLINE void raiseBase(std::uint32_t by) {
        std::uint32_t before = base_;
        base_ += by;
        if (base_ < before)
            carry(at_);
    }

    // The code is a number below 1: a carry out of the first byte can't happen.
    STIPPLE_LAZ_COLD static void carry(std::uint8_t* at) {
        do
            --at;
        while (++*at == 0);
    }

    STIPPLE_LAZ_INLINE void renormalize() {
        while (length_ < minIntervalLength) {
            *at_++ = static_cast<std::uint8_t>(base_ >> 24);
            base_ <<= 8;
            length_ <<= 8;
        }
    }

    std::uint8_t* at_ = nullptr;
    std::uint32_t base_ = 0, length_ = 0xFFFFFFFFu;
};

// The growing bytes of one encoder.
//
//   stream.start();
//   for each record: stream.ensureRoom(worst bytes of a record); … stream.encoder.encodeSymbol(…)
//   stream.finish() → bytes, valid until the next start()
class EncodedStream {
  public:
    ArithmeticEncoder encoder;

    void start() { startBehind({}); }
    // The bytes begin with `front`, as it is.
    void startBehind(ByteSpan front) {
        if (bytes_.size() < front.size() + 1024)
            bytes_.resize(front.size() + 1024);
        std::copy(front.begin(), front.end(), bytes_.begin());
        encoder = ArithmeticEncoder(bytes_.data() + front.size());
    }
    // Room for `size` more bytes and those of finish().
    void ensureRoom(std::size_t size) {
        std::size_t used = static_cast<std::size_t>(encoder.position() - bytes_.data());
        std::size_t needed = used + size + 16;
        if (needed <= bytes_.size())
            return;
        bytes_.resize(needed + needed / 2);
        encoder.moveTo(bytes_.data() + used);
    }
    ByteSpan finish() {
        ensureRoom(0);
        encoder.finish();
        return {bytes_.data(), static_cast<std::size_t>(encoder.position() - bytes_.data())};
    }

  private:
    Bytes bytes_;
};

} // namespace stipple::las::laz
