#include "converter/input/e57/bitpack.hpp"

#include <algorithm>

namespace stipple::e57 {

namespace {
// The sum wraps where a stream holds more than its field's maximum; such values stay defined.
std::int64_t plus(std::int64_t minimum, std::uint64_t value) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(minimum) + value);
}

template <class T>
void unpackWhole(const std::uint8_t* packed, std::int64_t minimum, std::span<std::int64_t> out) {
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = plus(minimum, loadLe<T>(packed + i * sizeof(T)));
}

// Up to 57 bits lie in the eight bytes from the one they begin in.
void unpackNarrow(const std::uint8_t* packed, std::uint64_t at, std::uint64_t bits, std::int64_t minimum,
                  std::span<std::int64_t> out) {
    const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
    for (std::int64_t& value : out) {
        value = plus(minimum, (loadLe<std::uint64_t>(packed + (at >> 3)) >> (at & 7)) & mask);
        at += bits;
    }
}

// More reach into a ninth byte.
void unpackWide(const std::uint8_t* packed, std::uint64_t at, std::uint64_t bits, std::int64_t minimum,
                std::span<std::int64_t> out) {
    const std::uint64_t mask = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
    for (std::int64_t& value : out) {
        const std::uint8_t* from = packed + (at >> 3);
        std::uint64_t shift = at & 7;
        std::uint64_t low = loadLe<std::uint64_t>(from) >> shift;
        std::uint64_t high = shift == 0 ? 0 : std::uint64_t{from[8]} << (64 - shift);
        value = plus(minimum, (low | high) & mask);
        at += bits;
    }
}
} // namespace

void unpackIntegers(const std::uint8_t* packed, int firstBit, int bits, std::int64_t minimum,
                    std::span<std::int64_t> out) {
    if (bits == 0)
        return std::fill(out.begin(), out.end(), minimum);
    if (firstBit == 0) {
        if (bits == 8)
            return unpackWhole<std::uint8_t>(packed, minimum, out);
        if (bits == 16)
            return unpackWhole<std::uint16_t>(packed, minimum, out);
        if (bits == 32)
            return unpackWhole<std::uint32_t>(packed, minimum, out);
        if (bits == 64)
            return unpackWhole<std::uint64_t>(packed, minimum, out);
    }
    auto at = static_cast<std::uint64_t>(firstBit), width = static_cast<std::uint64_t>(bits);
    if (bits <= 57)
        return unpackNarrow(packed, at, width, minimum, out);
    return unpackWide(packed, at, width, minimum, out);
}

} // namespace stipple::e57
