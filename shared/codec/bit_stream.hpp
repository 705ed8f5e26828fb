// Bits in a byte stream, lowest bit of the lowest byte first.
#pragma once

#include "shared/base/bytes.hpp"

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

// Reads at any bit, from a copy that is padded so that no read leaves it. Reads past the end of the
// stream give zeros for as long as the caller keeps `at() <= sizeBits() + 64`; it checks
// `ok()` at least that often.
class BitReader {
  public:
    explicit BitReader(ByteSpan stream) : bytes_(stream.begin(), stream.end()) {
        bytes_.resize(stream.size() + padding);
    }

    // `count` is 0..63.
    std::uint64_t read(int count) {
        const std::uint8_t* from = bytes_.data() + (at_ >> 3);
        std::uint64_t low = loadLe<std::uint64_t>(from) >> (at_ & 7);
        // Eight bytes hold at least 57 bits from any start; the ninth has the rest.
        if (count > 57) [[unlikely]]
            low |= (at_ & 7) == 0 ? 0 : std::uint64_t{from[8]} << (64 - (at_ & 7));
        at_ += static_cast<std::uint64_t>(count);
        return low & ((std::uint64_t{1} << count) - 1);
    }
    bool ok() const { return at_ <= sizeBits(); }
    std::uint64_t at() const { return at_; }
    std::uint64_t sizeBits() const { return 8 * (bytes_.size() - padding); }

  private:
    static constexpr std::size_t padding = 24;
    Bytes bytes_;
    std::uint64_t at_ = 0;
};

} // namespace stipple
