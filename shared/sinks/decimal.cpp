#include "shared/sinks/decimal.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string_view>

namespace stipple {

namespace {

__extension__ using Int128 = __int128;
__extension__ using UInt128 = unsigned __int128;

constexpr int maxPlaces = 30;

template <class T>
void appendChars(std::string& text, T value) {
    char buffer[64];
    auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
    text.append(buffer, end.ptr);
}

// digits × 10^-places
struct Decimal {
    std::int64_t digits = 0;
    int places = 0;
};

// The shortest decimal of a double: "-1.25e-05" is -125 × 10^-7.
std::optional<Decimal> shortestDecimal(double value) {
    const std::string shortest = shortestScientific(value);
    std::string_view text(shortest);
    std::size_t e = text.find('e');
    if (e == std::string_view::npos) // inf, nan
        return std::nullopt;
    std::string digits;
    int places = -std::atoi(std::string(text.substr(e + 1)).c_str());
    bool fraction = false;
    for (char c : text.substr(0, e)) {
        if (c == '.') {
            fraction = true;
            continue;
        }
        digits += c;
        places += fraction ? 1 : 0;
    }
    Decimal decimal{std::strtoll(digits.c_str(), nullptr, 10), places};
    while (decimal.digits % 10 == 0 && decimal.places > 0 && decimal.digits != 0) {
        decimal.digits /= 10;
        --decimal.places;
    }
    if (decimal.digits == 0)
        decimal.places = 0;
    return decimal;
}

// value × 10^power, unless that leaves 2^100.
std::optional<Int128> timesPowerOfTen(std::int64_t value, int power) {
    constexpr Int128 limit = Int128{1} << 100;
    Int128 result = value;
    for (int i = 0; i < power && result != 0; ++i) {
        result *= 10;
        if (result > limit || result < -limit)
            return std::nullopt;
    }
    return result;
}

bool fits64(Int128 value) {
    return value >= std::numeric_limits<std::int64_t>::min() &&
           value <= std::numeric_limits<std::int64_t>::max();
}

// Digits of |value| with the point `places` digits from their end.
void appendDigits(std::string& text, UInt128 value, int places) {
    char buffer[80];
    char* at = buffer + sizeof buffer;
    int written = 0;
    auto put = [&](unsigned digit) {
        if (written == places && places > 0)
            *--at = '.';
        *--at = static_cast<char>('0' + digit);
        ++written;
    };
    while (value > std::numeric_limits<std::uint64_t>::max()) {
        put(static_cast<unsigned>(value % 10));
        value /= 10;
    }
    auto low = static_cast<std::uint64_t>(value);
    while (low != 0 || written <= places) {
        put(static_cast<unsigned>(low % 10));
        low /= 10;
    }
    text.append(at, static_cast<std::size_t>(buffer + sizeof buffer - at));
}

} // namespace

DecimalScale::DecimalScale(double scale, double offset, std::int64_t least, std::int64_t greatest)
    : scale_(scale), offset_(offset), least_(least), greatest_(greatest) {
    auto step = shortestDecimal(scale), start = shortestDecimal(offset);
    if (!step || !start)
        return;
    int places = std::max({step->places, start->places, 0});
    if (places > maxPlaces)
        return;
    auto factor = timesPowerOfTen(step->digits, places - step->places);
    auto summand = timesPowerOfTen(start->digits, places - start->places);
    constexpr Int128 narrow = std::numeric_limits<std::int64_t>::max();
    if (!factor || !summand || *factor > narrow || *factor < -narrow)
        return;
    factor_ = *factor;
    summand_ = *summand;
    places_ = places;
    narrow_ = fits64(summand_) && fits64(factor_ * least) && fits64(factor_ * greatest) &&
              fits64(factor_ * least + summand_) && fits64(factor_ * greatest + summand_);
}

void DecimalScale::append(std::string& text, std::int64_t n) const {
    if (places_ < 0)
        return appendShortest(text, offset_ + scale_ * static_cast<double>(n));
    if (narrow_ && n >= least_ && n <= greatest_) {
        std::int64_t value = static_cast<std::int64_t>(factor_) * n + static_cast<std::int64_t>(summand_);
        if (value < 0)
            text += '-';
        auto magnitude =
            value < 0 ? 0 - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
        return appendDigits(text, magnitude, places_);
    }
    Int128 value = factor_ * n + summand_;
    if (value < 0)
        text += '-';
    appendDigits(text, static_cast<UInt128>(value < 0 ? -value : value), places_);
}

void appendInteger(std::string& text, std::int64_t value) {
    appendChars(text, value);
}
void appendInteger(std::string& text, std::uint64_t value) {
    appendChars(text, value);
}

} // namespace stipple
