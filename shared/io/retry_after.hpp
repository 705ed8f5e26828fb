// The header field Retry-After (RFC 9110 §10.2.3).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace stipple {

// The field in seconds, as text. Of a date that is how long it lies after the answer's own, `date` (clocks
// differ), or after `nowSeconds` (since 1970-01-01 UTC) where the answer has none; 0 if it is past. What is
// no date stays as it is.
std::string retryAfterInSeconds(std::string_view retryAfter, std::string_view date, std::int64_t nowSeconds);

} // namespace stipple
