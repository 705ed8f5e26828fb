// Unsigned integers in 7-bit groups, lowest first; the top bit of a byte says that another follows
// (LEB128, as in protocol buffers). Signed ones are zigzag-mapped first: 0, -1, 1, -2, …
#pragma once

#include "shared/base/bytes.hpp"

namespace stipple {

inline void writeVarint(ByteWriter& to, std::uint64_t value) {
    for (; value >= 0x80; value >>= 7)
        to.write<std::uint8_t>(static_cast<std::uint8_t>(value | 0x80));
    to.write<std::uint8_t>(static_cast<std::uint8_t>(value));
}

// Zero, with `from` still ok, for the bits of a group beyond the 64th; the tenth byte ends a number.
inline std::uint64_t readVarint(ByteReader& from) {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 70; shift += 7) {
        std::uint8_t byte = from.read<std::uint8_t>();
        value |= shift < 64 ? static_cast<std::uint64_t>(byte & 0x7F) << shift : 0;
        if (byte < 0x80)
            break;
    }
    return value;
}

inline std::uint64_t zigzag(std::int64_t value) {
    return (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63);
}
inline std::int64_t unzigzag(std::uint64_t value) {
    return static_cast<std::int64_t>((value >> 1) ^ (0 - (value & 1)));
}

} // namespace stipple
