#include "converter/input/text_number.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

namespace stipple {

namespace {
constexpr int mostDigits = 18; // that fit for certain: 10^18 < 2^63
constexpr int largestExponent = 100'000;

constexpr std::array<std::int64_t, 19> powers = [] {
    std::array<std::int64_t, 19> table{1};
    for (std::size_t i = 1; i < table.size(); ++i)
        table[i] = table[i - 1] * 10;
    return table;
}();
// Powers of ten that a double, and a float, hold exactly.
constexpr int exactDoublePower = 22;
constexpr std::array<double, 23> doublePowers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                              1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                              1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
constexpr int exactFloatPower = 10;
constexpr std::array<float, 11> floatPowers{1e0f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f,
                                            1e6f, 1e7f, 1e8f, 1e9f, 1e10f};

unsigned digit(char c) {
    return static_cast<unsigned>(static_cast<unsigned char>(c)) - '0';
}
char lower(char c) {
    return static_cast<char>(c | 0x20);
}

bool startsWith(const char* at, std::string_view word) {
    for (char c : word)
        if (lower(*at++) != c)
            return false;
    return true;
}

// "nan", "nan(ind)", "inf", "infinity" behind the sign, or "qnan", "snan", "ind", "inf" behind "1.#".
const char* scanWord(const char* at, Number& number) {
    struct Word {
        std::string_view text;
        Number::Kind kind;
    };
    constexpr std::array words{Word{"infinity", Number::Kind::infinite}, Word{"inf", Number::Kind::infinite},
                               Word{"nan", Number::Kind::nan},           Word{"qnan", Number::Kind::nan},
                               Word{"snan", Number::Kind::nan},          Word{"ind", Number::Kind::nan}};
    for (const Word& word : words)
        if (startsWith(at, word.text)) {
            number.kind = word.kind;
            number.mantissa = 0;
            number.exponent = 0;
            at += word.text.size();
            if (*at != '(')
                return at;
            const char* inside = at + 1;
            while (lower(*inside) >= 'a' && lower(*inside) <= 'z')
                ++inside;
            return *inside == ')' ? inside + 1 : at;
        }
    return nullptr;
}

// The digits that fit into 63 bits of a number with more than 18 in all.
void scanLongMantissa(const char* at, char decimalPoint, std::uint64_t& mantissa, int& exponent, bool& cut) {
    constexpr std::uint64_t largest = std::numeric_limits<std::int64_t>::max();
    std::int64_t dropped = 0, decimals = 0;
    bool behindPoint = false, full = false;
    mantissa = 0;
    for (;; ++at) {
        unsigned d = digit(*at);
        if (d > 9) {
            if (behindPoint || *at != decimalPoint)
                break;
            behindPoint = true;
            continue;
        }
        full = full || mantissa > (largest - d) / 10;
        if (!full) {
            mantissa = mantissa * 10 + d;
            decimals += behindPoint ? 1 : 0;
        } else {
            cut = cut || d != 0;
            dropped += behindPoint ? 0 : 1;
        }
    }
    std::int64_t power = dropped - decimals;
    exponent = static_cast<int>(
        std::max<std::int64_t>(std::min<std::int64_t>(power, largestExponent), -largestExponent));
}

// The value in decimal digits again, for the library to round.
template <class T>
T fromDigits(const Number& number) {
    std::array<char, 64> text;
    char* at = text.data();
    if (number.negative)
        *at++ = '-';
    std::int64_t magnitude = number.mantissa < 0 ? -number.mantissa : number.mantissa;
    at = std::to_chars(at, text.data() + text.size() - 16, magnitude).ptr;
    int exponent = number.exponent;
    if (number.cut) { // anything above what is there: no tie remains
        *at++ = '1';
        --exponent;
    }
    *at++ = 'e';
    at = std::to_chars(at, text.data() + text.size(), exponent).ptr;
    T value{};
    auto read = std::from_chars(text.data(), at, value);
    if (read.ec == std::errc::result_out_of_range) {
        bool large = exponent > 0;
        value = large ? std::numeric_limits<T>::infinity() : T{0};
        return number.negative ? -value : value;
    }
    return value;
}

template <class T>
T special(const Number& number) {
    if (number.kind == Number::Kind::nan)
        return std::numeric_limits<T>::quiet_NaN();
    return number.negative ? -std::numeric_limits<T>::infinity() : std::numeric_limits<T>::infinity();
}
} // namespace

const char* scanNumber(const char* at, char decimalPoint, Number& number) {
    number = Number{};
    number.negative = *at == '-';
    if (*at == '-' || *at == '+')
        ++at;
    const char* first = at;
    std::uint64_t mantissa = 0;
    unsigned d;
    while ((d = digit(*at)) <= 9) {
        mantissa = mantissa * 10 + d;
        ++at;
    }
    std::ptrdiff_t digits = at - first;
    int exponent = 0;
    if (*at == decimalPoint) {
        const char* behind = ++at;
        while ((d = digit(*at)) <= 9) {
            mantissa = mantissa * 10 + d;
            ++at;
        }
        std::ptrdiff_t decimals = at - behind;
        digits += decimals;
        exponent = -static_cast<int>(std::min<std::ptrdiff_t>(decimals, largestExponent));
        number.fractional = true;
        if (*at == '#' && digits > 0)
            return scanWord(at + 1, number);
    }
    if (digits == 0)
        return number.fractional ? nullptr : scanWord(at, number);
    if (digits > mostDigits)
        scanLongMantissa(first, decimalPoint, mantissa, exponent, number.cut);
    if (lower(*at) == 'e') {
        const char* sign = at + 1;
        bool minus = *sign == '-';
        const char* power = minus || *sign == '+' ? sign + 1 : sign;
        int value = 0;
        const char* end = power;
        while ((d = digit(*end)) <= 9) {
            value = std::min(value * 10 + static_cast<int>(d), largestExponent);
            ++end;
        }
        if (end == power)
            return nullptr;
        exponent = std::max(std::min(exponent + (minus ? -value : value), largestExponent), -largestExponent);
        number.fractional = true;
        at = end;
    }
    std::int64_t magnitude = static_cast<std::int64_t>(mantissa);
    number.mantissa = number.negative ? -magnitude : magnitude;
    number.exponent = exponent;
    return at;
}

double toDouble(const Number& number) {
    constexpr std::int64_t exactIntegers = std::int64_t{1} << 53;
    if (!number.isFinite())
        return special<double>(number);
    if (number.mantissa == 0)
        return number.negative ? -0.0 : 0.0;
    // Two exact operands and one rounding (Clinger's fast path).
    if (!number.cut && number.mantissa <= exactIntegers && number.mantissa >= -exactIntegers) {
        double mantissa = static_cast<double>(number.mantissa);
        if (number.exponent <= 0 && number.exponent >= -exactDoublePower)
            return mantissa / doublePowers[static_cast<std::size_t>(-number.exponent)];
        if (number.exponent > 0 && number.exponent <= exactDoublePower)
            return mantissa * doublePowers[static_cast<std::size_t>(number.exponent)];
    }
    return fromDigits<double>(number);
}

float toFloat(const Number& number) {
    constexpr std::int64_t exactIntegers = std::int64_t{1} << 24;
    if (!number.isFinite())
        return special<float>(number);
    if (number.mantissa == 0)
        return number.negative ? -0.0f : 0.0f;
    if (!number.cut && number.mantissa <= exactIntegers && number.mantissa >= -exactIntegers) {
        float mantissa = static_cast<float>(number.mantissa);
        if (number.exponent <= 0 && number.exponent >= -exactFloatPower)
            return mantissa / floatPowers[static_cast<std::size_t>(-number.exponent)];
        if (number.exponent > 0 && number.exponent <= exactFloatPower)
            return mantissa * floatPowers[static_cast<std::size_t>(number.exponent)];
    }
    return fromDigits<float>(number);
}

WholeNumber toWhole(const Number& number) {
    if (!number.isFinite() || number.cut)
        return {};
    if (number.mantissa == 0 || number.exponent == 0)
        return {true, number.mantissa};
    if (number.exponent < 0) {
        if (number.exponent < -mostDigits)
            return {};
        std::int64_t power = powers[static_cast<std::size_t>(-number.exponent)];
        return {number.mantissa % power == 0, number.mantissa / power};
    }
    WholeNumber whole;
    whole.fits = number.exponent <= mostDigits &&
                 !__builtin_mul_overflow(number.mantissa, powers[static_cast<std::size_t>(number.exponent)],
                                         &whole.value);
    return whole;
}

std::int64_t powerOfTen64(int exponent) {
    return powers[static_cast<std::size_t>(exponent)];
}

} // namespace stipple
