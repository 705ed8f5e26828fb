#include "shared/io/retry_after.hpp"

#include "shared/io/http_date.hpp"

#include <algorithm>

namespace stipple {

std::string retryAfterInSeconds(std::string_view retryAfter, std::string_view date, std::int64_t nowSeconds) {
    auto until = parseHttpDate(retryAfter, nowSeconds);
    if (!until)
        return std::string(retryAfter);
    std::int64_t from = parseHttpDate(date, nowSeconds).value_or(nowSeconds);
    return std::to_string(std::max<std::int64_t>(0, *until - from));
}

} // namespace stipple
