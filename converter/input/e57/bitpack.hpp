// The bit packing of records (ASTM E2807-11 §9.7.4): integers of a fixed number of bits, one after the other,
// lowest bit of the lowest byte first, each being the value less the field's minimum.
#pragma once

#include "shared/base/bytes.hpp"

#include <span>

namespace stipple::e57 {

// Bytes that must be readable behind the last one of a packed stream.
inline constexpr std::size_t unpackPadding = 16;

// Writes out.size() values of `bits` (0..64) bits each, the first beginning at bit `firstBit` (0..7) of
// `packed`, plus `minimum`. `packed` holds them all, and unpackPadding more.
void unpackIntegers(const std::uint8_t* packed, int firstBit, int bits, std::int64_t minimum,
                    std::span<std::int64_t> out);

} // namespace stipple::e57
