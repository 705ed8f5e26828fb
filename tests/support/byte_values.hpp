// What a test that damages bytes one by one tries in each of them.
#pragma once

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
