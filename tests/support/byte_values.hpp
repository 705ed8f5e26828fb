// Bytes that tests are made of, and what those that damage bytes one by one try in each of them.
#pragma once

#include "shared/base/bytes.hpp"

#include <cstdint>
#include <vector>

namespace stipple::test {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool isAddressSanitized = true;
#elif defined(__has_feature)
inline constexpr bool isAddressSanitized = __has_feature(address_sanitizer);
#else
inline constexpr bool isAddressSanitized = false;
#endif

// `first`, the one after it, and so on; 0 comes after 255.
inline Bytes countingBytes(std::uint64_t first, std::size_t count) {
    Bytes bytes(count);
    for (std::size_t i = 0; i < count; ++i)
        bytes[i] = static_cast<std::uint8_t>(first + i);
    return bytes;
}

// The extremes, and every value that differs from `original` in one bit.
inline std::vector<std::uint8_t> likelyDamage(std::uint8_t original) {
    std::vector<std::uint8_t> values{0, 255};
    for (int bit = 0; bit < 8; ++bit)
        values.push_back(static_cast<std::uint8_t>(original ^ (1 << bit)));
    return values;
}

// All 256. Under the address sanitizer, which takes twenty times as long: likely damage and small numbers,
// among them all that formats, versions and kinds can be (fuzz targets try the others there).
inline std::vector<std::uint8_t> everyDamage(std::uint8_t original) {
    std::vector<std::uint8_t> values;
    if (isAddressSanitized)
        values = likelyDamage(original);
    for (unsigned value = 0; value < (isAddressSanitized ? 24 : 256); ++value)
        values.push_back(static_cast<std::uint8_t>(value));
    return values;
}

// As many different damages of a whole file as `all`; a third of them under the address sanitizer.
inline constexpr int damages(int all) {
    return isAddressSanitized ? all / 3 : all;
}

} // namespace stipple::test
