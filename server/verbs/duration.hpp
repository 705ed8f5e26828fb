// Spans of time as people type them: "90d", "12h", "30m", "45s".
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace stipple::server {

// Whole seconds, 1 s to 100 years; "w" is 7 days. Nothing for anything else.
std::optional<std::int64_t> parseDuration(std::string_view text);

} // namespace stipple::server
