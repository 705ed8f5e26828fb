// Text out of parts, for messages: cat("node ", key, " has ", count, " points").
#pragma once

#include <concepts>
#include <cstdio>
#include <string>
#include <string_view>

namespace stipple {

namespace detail {
inline void append(std::string& to, std::string_view part) {
    to += part;
}
inline void append(std::string& to, char part) {
    to += part;
}
// A template, so that a pointer prefers string_view to its conversion to bool.
template <std::same_as<bool> T>
void append(std::string& to, T part) {
    to += part ? "true" : "false";
}
template <std::integral T>
requires(!std::same_as<T, bool> && !std::same_as<T, char>) void append(std::string& to, T part) {
    to += std::to_string(part);
}
// A Phrase (phrase.hpp), and what else knows its text.
template <class T>
requires requires(const T& part) {
    { part.text() } -> std::same_as<std::string>;
}
void append(std::string& to, const T& part) {
    to += part.text();
}
template <std::floating_point T>
void append(std::string& to, T part) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%.10g", static_cast<double>(part));
    to += buffer;
}
} // namespace detail

template <class... Parts>
std::string cat(const Parts&... parts) {
    std::string text;
    (detail::append(text, parts), ...);
    return text;
}

} // namespace stipple
