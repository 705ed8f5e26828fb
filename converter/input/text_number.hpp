// Numbers as text writes them: digits and a power of ten, so that nothing is rounded before it is known what
// the number is for.
#pragma once

#include <cstdint>

namespace stipple {

struct Number {
    enum class Kind : std::uint8_t { finite, nan, infinite };

    std::int64_t mantissa = 0; // value = mantissa × 10^exponent
    std::int32_t exponent = 0; // within ±100,000
    Kind kind = Kind::finite;
    bool negative = false;   // of "-0" as well
    bool cut = false;        // digits that do not fit were left out, and not all were zeros
    bool fractional = false; // written with a point or an exponent

    bool isFinite() const { return kind == Kind::finite; }
    static Number missing() {
        Number number;
        number.kind = Kind::nan;
        return number;
    }
};

// Reads "-12.5e3", ".5", "1.", "nan", "-inf", "1.#QNAN" and the like at `at`. Answers the place behind, or
// null where no number stands. The text must end with a byte that no number contains, such as '\n'.
const char* scanNumber(const char* at, char decimalPoint, Number& number);

// The nearest double and the nearest float, ties to even, or where digits were cut, one of the two nearest;
// NaN and infinities as they are.
double toDouble(const Number& number);
float toFloat(const Number& number);

// The value as an integer, where it is one and fits; `fits` says so.
struct WholeNumber {
    bool fits = false;
    std::int64_t value = 0;
};
WholeNumber toWhole(const Number& number);

// 10^exponent, exactly; exponents from 0 to 18.
std::int64_t powerOfTen64(int exponent);

} // namespace stipple
