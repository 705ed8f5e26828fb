#include "server/verbs/duration.hpp"

#include <charconv>

namespace stipple::server {

std::optional<std::int64_t> parseDuration(std::string_view text) {
    constexpr std::int64_t day = 86400, longest = 36525 * day;
    if (text.empty())
        return std::nullopt;
    std::int64_t unit = 0;
    switch (text.back()) {
    case 's':
        unit = 1;
        break;
    case 'm':
        unit = 60;
        break;
    case 'h':
        unit = 3600;
        break;
    case 'd':
        unit = day;
        break;
    case 'w':
        unit = 7 * day;
        break;
    default:
        return std::nullopt;
    }
    text.remove_suffix(1);
    std::int64_t count = 0;
    auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error != std::errc() || end != text.data() + text.size() || count < 1 || count > longest / unit)
        return std::nullopt;
    return count * unit;
}

} // namespace stipple::server
