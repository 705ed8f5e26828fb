#include "converter/input/e57/crc32c.hpp"

#include <array>

#if defined(__x86_64__)
#include <nmmintrin.h>
#endif

namespace stipple::e57 {

namespace {
constexpr std::uint32_t reflectedPolynomial = 0x82F63B78;

// tables[k][b]: what byte b adds to the remainder once k more bytes have gone by.
using Tables = std::array<std::array<std::uint32_t, 256>, 8>;
constexpr Tables makeTables() {
    Tables tables{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t rest = byte;
        for (int bit = 0; bit < 8; ++bit)
            rest = (rest >> 1) ^ ((rest & 1) != 0 ? reflectedPolynomial : 0);
        tables[0][byte] = rest;
    }
    for (std::size_t k = 1; k < 8; ++k)
        for (std::size_t byte = 0; byte < 256; ++byte)
            tables[k][byte] = (tables[k - 1][byte] >> 8) ^ tables[0][tables[k - 1][byte] & 0xFF];
    return tables;
}
constexpr Tables tables = makeTables();

#if defined(__x86_64__)
__attribute__((target("sse4.2"))) std::uint32_t crc32cByInstruction(ByteSpan bytes) {
    const std::uint8_t* at = bytes.data();
    std::size_t left = bytes.size();
    std::uint64_t rest = 0xFFFFFFFFu;
    for (; left >= 8; left -= 8, at += 8)
        rest = _mm_crc32_u64(rest, loadLe<std::uint64_t>(at));
    for (; left > 0; --left, ++at)
        rest = _mm_crc32_u8(static_cast<std::uint32_t>(rest), *at);
    return ~static_cast<std::uint32_t>(rest);
}
#endif
} // namespace

std::uint32_t crc32cByTable(ByteSpan bytes) {
    const std::uint8_t* at = bytes.data();
    std::size_t left = bytes.size();
    std::uint32_t rest = 0xFFFFFFFFu;
    for (; left >= 8; left -= 8, at += 8) {
        std::uint64_t word = loadLe<std::uint64_t>(at) ^ rest;
        rest = 0;
        for (std::size_t k = 0; k < 8; ++k)
            rest ^= tables[7 - k][(word >> (8 * k)) & 0xFF];
    }
    for (; left > 0; --left, ++at)
        rest = (rest >> 8) ^ tables[0][(rest ^ *at) & 0xFF];
    return ~rest;
}

std::uint32_t crc32c(ByteSpan bytes) {
#if defined(__x86_64__)
    static const bool hasInstruction = __builtin_cpu_supports("sse4.2");
    if (hasInstruction)
        return crc32cByInstruction(bytes);
#endif
    return crc32cByTable(bytes);
}

} // namespace stipple::e57
