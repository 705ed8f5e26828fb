// Which clouds a rule speaks of: ids, in which "*" stands for any run of characters.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stipple::server {

// "survey-*" matches "survey-2024" and "survey-". Time: at most the product of the sizes.
bool matchesPattern(std::string_view pattern, std::string_view id);
bool matchesAny(const std::vector<std::string>& patterns, std::string_view id);

// What may be in a pattern: the characters of ids, and "*".
bool isIdPattern(std::string_view pattern);

} // namespace stipple::server
