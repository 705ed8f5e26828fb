// Dates of HTTP fields (RFC 9110 §5.6.7), as seconds since 1970-01-01 UTC.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace stipple {

// "Sun, 06 Nov 1994 08:49:37 GMT". Years 0 to 9999.
std::string httpDate(std::int64_t seconds);

// Any of the three forms that a recipient must accept: IMF-fixdate, RFC 850 and asctime. `nowSeconds` decides
// the century of the two-digit years of RFC 850: at most 50 years ahead.
std::optional<std::int64_t> parseHttpDate(std::string_view text, std::int64_t nowSeconds);

} // namespace stipple
