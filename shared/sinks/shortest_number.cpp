#include "shared/sinks/shortest_number.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <version>

namespace stipple {

namespace {

constexpr std::size_t bufferSize = 400; // a double in full has up to 309 digits before the point

float readBack(const char* text, float) {
    return std::strtof(text, nullptr);
}
double readBack(const char* text, double) {
    return std::strtod(text, nullptr);
}

template <class T>
std::string scientific(T value) {
    char buffer[bufferSize];
    for (int digits = 0; digits < 17; ++digits) {
        std::snprintf(buffer, sizeof buffer, "%.*e", digits, static_cast<double>(value));
        if (readBack(buffer, value) == value)
            return buffer;
    }
    return buffer; // infinite, or no number
}

// The shorter of both ways to write it; without an exponent, if they are of one length.
template <class T>
void append(std::string& text, T value) {
    std::string withExponent = scientific(value);
    if (!std::isfinite(value)) {
        text += withExponent;
        return;
    }
    std::size_t e = withExponent.find('e'), first = withExponent[0] == '-' ? 1 : 0;
    int exponent = std::atoi(withExponent.c_str() + e + 1);
    int behindFirst = static_cast<int>(e - first) - 1; // digits, and the point before them
    int decimals = (behindFirst > 0 ? behindFirst - 1 : 0) - exponent;
    char buffer[bufferSize];
    if (decimals > 50)
        buffer[0] = 0;
    else
        std::snprintf(buffer, sizeof buffer, "%.*f", decimals > 0 ? decimals : 0, static_cast<double>(value));
    std::string plain = buffer;
    text += !plain.empty() && plain.size() <= withExponent.size() ? plain : withExponent;
}

} // namespace

namespace portable {

void appendShortest(std::string& text, double value) {
    append(text, value);
}
void appendShortest(std::string& text, float value) {
    append(text, value);
}
std::string shortestScientific(double value) {
    return scientific(value);
}

} // namespace portable

#ifdef __cpp_lib_to_chars

namespace {
template <class T>
void appendByLibrary(std::string& text, T value) {
    char buffer[bufferSize];
    auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
    text.append(buffer, end.ptr);
}
} // namespace

void appendShortest(std::string& text, double value) {
    appendByLibrary(text, value);
}
void appendShortest(std::string& text, float value) {
    appendByLibrary(text, value);
}
std::string shortestScientific(double value) {
    char buffer[bufferSize];
    auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific);
    return {buffer, end.ptr};
}

#else

void appendShortest(std::string& text, double value) {
    portable::appendShortest(text, value);
}
void appendShortest(std::string& text, float value) {
    portable::appendShortest(text, value);
}
std::string shortestScientific(double value) {
    return portable::shortestScientific(value);
}

#endif

} // namespace stipple
