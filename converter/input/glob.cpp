#include "converter/input/glob.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace stipple {

namespace {
// The character at `at`, which moves behind it. A byte that is no UTF-8 is a character of its own, above
// all of Unicode.
std::uint32_t nextCharacter(std::string_view text, std::size_t& at) {
    constexpr std::uint32_t strayByte = 0x110000;
    auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    std::uint8_t first = byte(at++);
    if (first < 0x80)
        return first;
    std::size_t more = first >= 0xF0 && first < 0xF8 ? 3 : first >= 0xE0 ? 2 : first >= 0xC0 ? 1 : 0;
    if (more == 0 || first >= 0xF8 || at + more > text.size())
        return strayByte + first;
    std::uint32_t character = first & (0x3Fu >> more);
    for (std::size_t i = 0; i < more; ++i) {
        if ((byte(at + i) & 0xC0) != 0x80)
            return strayByte + first;
        character = character << 6 | (byte(at + i) & 0x3Fu);
    }
    at += more;
    return character;
}

// Whether the bracket expression at `at` (its '[') holds `character`; moves `at` behind it. Nothing if
// the bracket is never closed.
std::optional<bool> matchBracket(std::string_view pattern, std::size_t& at, std::uint32_t character) {
    std::size_t p = at + 1;
    bool others = p < pattern.size() && (pattern[p] == '!' || pattern[p] == '^');
    p += others ? 1 : 0;
    bool found = false;
    for (std::size_t first = p; p < pattern.size();) {
        if (pattern[p] == ']' && p > first) {
            at = p + 1;
            return found != others;
        }
        std::uint32_t low = nextCharacter(pattern, p), high = low;
        if (p + 1 < pattern.size() && pattern[p] == '-' && pattern[p + 1] != ']')
            high = nextCharacter(pattern, ++p);
        found = found || (character >= low && character <= high);
    }
    return std::nullopt;
}

// Whether the pattern's element at `p`, no star, fits the name's character at `n`; moves both if so.
bool matchOne(std::string_view name, std::size_t& n, std::string_view pattern, std::size_t& p) {
    std::size_t afterName = n, afterPattern = p;
    std::uint32_t character = nextCharacter(name, afterName);
    bool fits = true;
    if (pattern[p] == '?') {
        ++afterPattern;
    } else if (auto bracket = pattern[p] == '[' ? matchBracket(pattern, afterPattern, character)
                                                : std::optional<bool>{}) {
        fits = *bracket;
    } else {
        fits = nextCharacter(pattern, afterPattern) == character;
    }
    if (fits) {
        n = afterName;
        p = afterPattern;
    }
    return fits;
}
} // namespace

bool isPattern(std::string_view text) {
    return text.find_first_of("*?[") != std::string_view::npos;
}

bool matchesPattern(std::string_view name, std::string_view pattern) {
    if (name.starts_with('.') && !pattern.starts_with('.'))
        return false;
    std::size_t n = 0, p = 0;
    // Where to go on when a star has to take one character more.
    std::size_t starPattern = std::string_view::npos, starName = 0;
    while (n < name.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            starPattern = ++p;
            starName = n;
        } else if (p < pattern.size() && matchOne(name, n, pattern, p)) {
            continue;
        } else if (starPattern != std::string_view::npos) {
            nextCharacter(name, starName);
            n = starName;
            p = starPattern;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

} // namespace stipple
