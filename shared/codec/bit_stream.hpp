// Bits in a byte stream, lowest bit of the lowest byte first.
#pragma once

#include "shared/base/bytes.hpp"

#include <algorithm>
#include <bit>

namespace stipple {

inline int bitLength(std::uint64_t value) {
    return 64 - std::countl_zero(value);
}

class BitWriter {
  public:
    // The low `count` bits of `value`, 0..63; bits above are ignored.
    void write(std::uint64_t value, int count) {
        value &= (std::uint64_t{1} << count) - 1;
        pending_ |= value << used_;
        if (used_ + count >= 64) {
            bytes_.write(pending_);
            pending_ = used_ == 0 ? 0 : value >> (64 - used_);
            used_ += count - 64;
        } else {
            used_ += count;
        }
    }

    // The stream so far, its last byte filled up with zeros.
    Bytes take() {
        for (; used_ > 0; used_ -= 8, pending_ >>= 8)
            bytes_.write<std::uint8_t>(static_cast<std::uint8_t>(pending_));
        used_ = 0;
        return bytes_.take();
    }

  private:
    ByteWriter bytes_;
    std::uint64_t pending_ = 0;
    int used_ = 0;
};

// Bytes with zeros behind them, so that a BitReader may read whole words up to their end.
class PaddedBytes {
  public:
    static constexpr std::size_t padding = 24;

    explicit PaddedBytes(ByteSpan bytes) : bytes_(bytes.size() + padding), size_(bytes.size()) {
        std::copy(bytes.begin(), bytes.end(), bytes_.begin());
    }
    const std::uint8_t* data() const { return bytes_.data(); }
    std::size_t size() const { return size_; }

  private:
    Bytes bytes_;
    std::size_t size_;
};

// Reads numbers one after the other. Past the end of the stream there are zeros for one read of any width;
// so callers check `ok()` at least before each read. Small and without ownership: loops work on
// a copy, which stays in registers.
class BitReader {
  public:
    explicit BitReader(const PaddedBytes& stream)
        : from_(stream.data()), sizeBits_(8 * std::uint64_t{stream.size()}) {}

    // `count` is 0..63.
    std::uint64_t read(int count) {
        const std::uint8_t* from = from_ + (at_ >> 3);
        std::uint64_t low = loadLe<std::uint64_t>(from) >> (at_ & 7);
        // Eight bytes hold at least 57 bits from any start; the ninth has the rest.
        if (count > 57) [[unlikely]]
            low |= (at_ & 7) == 0 ? 0 : std::uint64_t{from[8]} << (64 - (at_ & 7));
        at_ += static_cast<std::uint64_t>(count);
        return low & ((std::uint64_t{1} << count) - 1);
    }
    bool ok() const { return at_ <= sizeBits_; }

  private:
    const std::uint8_t* from_;
    std::uint64_t at_ = 0, sizeBits_;
};

} // namespace stipple
