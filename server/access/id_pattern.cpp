#include "server/access/id_pattern.hpp"

#include <algorithm>
#include <cctype>

namespace stipple::server {

// Greedy: a star takes nothing at first, and one character more each time what follows it does not fit. Only
// the last star ever has to give way.
bool matchesPattern(std::string_view pattern, std::string_view id) {
    constexpr std::size_t none = std::string_view::npos;
    std::size_t p = 0, i = 0, star = none, starEnd = 0;
    while (i < id.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            starEnd = i;
        } else if (p < pattern.size() && pattern[p] == id[i]) {
            ++p;
            ++i;
        } else if (star != none) {
            p = star + 1;
            i = ++starEnd;
        } else {
            return false;
        }
    }
    while (p < pattern.size() && pattern[p] == '*')
        ++p;
    return p == pattern.size();
}

bool matchesAny(const std::vector<std::string>& patterns, std::string_view id) {
    return std::any_of(patterns.begin(), patterns.end(),
                       [&](const std::string& pattern) { return matchesPattern(pattern, id); });
}

bool isIdPattern(std::string_view pattern) {
    return !pattern.empty() && std::all_of(pattern.begin(), pattern.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' || c == '-' || c == '*';
    });
}

} // namespace stipple::server
