#include "converter/input/text_number.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

using namespace stipple;

namespace {
Number scan(const std::string& text) {
    std::string line = text + "\n";
    Number number;
    const char* end = scanNumber(line.c_str(), '.', number);
    INFO(text);
    REQUIRE(end != nullptr);
    REQUIRE(end - line.c_str() == static_cast<std::ptrdiff_t>(text.size()));
    return number;
}
bool isNumber(const std::string& text) {
    std::string line = text + "\n";
    Number number;
    const char* end = scanNumber(line.c_str(), '.', number);
    return end != nullptr && *end == '\n';
}
} // namespace

TEST_CASE("a number keeps its digits and its power of ten") {
    Number number = scan("-12.50e3");
    CHECK(number.mantissa == -1250);
    CHECK(number.exponent == 1);
    CHECK(scan("636110.300003").mantissa == 636110300003);
    CHECK(scan(".5").exponent == -1);
    CHECK(scan("7.").mantissa == 7);
    CHECK(scan("+3").mantissa == 3);
    CHECK(scan("9223372036854775807").mantissa == INT64_MAX);
    CHECK_FALSE(scan("9223372036854775807").cut);
    CHECK(scan("9223372036854775808").cut);
    CHECK(scan("0.00000000000000000000000000012").mantissa == 12);
    CHECK_FALSE(scan("1.000000000000000000000000").cut);
}

TEST_CASE("words for no number and infinity are read") {
    for (const char* text : {"nan", "NaN", "-nan", "nan(ind)", "1.#QNAN", "-1.#IND"})
        CHECK(scan(text).kind == Number::Kind::nan);
    for (const char* text : {"inf", "-Infinity", "1.#INF"})
        CHECK(scan(text).kind == Number::Kind::infinite);
    CHECK(std::isnan(toDouble(scan("nan"))));
    CHECK(toDouble(scan("-inf")) < 0);
}

TEST_CASE("what is no number is told") {
    for (const char* text : {"", "-", ".", "e5", "1e", "1e+", "1.2.3", "abc", "0x10", "--1", "1-2", "na"})
        CHECK_FALSE(isNumber(text));
}

TEST_CASE("doubles and floats are the nearest") {
    std::mt19937_64 random(7);
    for (int i = 0; i < 20000; ++i) {
        std::string text = std::to_string(static_cast<std::int64_t>(random()) >> (random() % 60));
        if (random() % 2 == 0)
            text.insert(text.size() - random() % (text.size() - (text[0] == '-' ? 1 : 0)), ".");
        if (random() % 3 == 0)
            text += std::to_string(random());
        if (random() % 2 == 0)
            text += "e" + std::to_string(static_cast<int>(random() % 80) - 40);
        INFO(text);
        Number number = scan(text);
        double expected = std::strtod(text.c_str(), nullptr);
        if (number.cut) { // digits 19 and on may decide between two neighbours
            REQUIRE(toDouble(number) >= std::nextafter(expected, -INFINITY));
            REQUIRE(toDouble(number) <= std::nextafter(expected, INFINITY));
            continue;
        }
        REQUIRE(toDouble(number) == expected);
        REQUIRE(toFloat(number) == std::strtof(text.c_str(), nullptr));
    }
    // Halfway between two floats, and just above: double rounding would get one of them wrong.
    for (const char* text : {"1.000000059604644775", "1.000000059604644776", "9007199254740993", "4.9e-324",
                             "1e-400", "1e400", "-0.0"}) {
        CHECK(toFloat(scan(text)) == std::strtof(text, nullptr));
        CHECK(toDouble(scan(text)) == std::strtod(text, nullptr));
    }
    CHECK(std::signbit(toDouble(scan("-0.0"))));
}

TEST_CASE("whole numbers are told from others") {
    CHECK(toWhole(scan("63.000")).fits);
    CHECK(toWhole(scan("63.000")).value == 63);
    CHECK(toWhole(scan("1.5e1")).value == 15);
    CHECK(toWhole(scan("-2e3")).value == -2000);
    CHECK_FALSE(toWhole(scan("0.5")).fits);
    CHECK_FALSE(toWhole(scan("1e19")).fits);
    CHECK_FALSE(toWhole(scan("1e-99999999999")).fits);
    CHECK_FALSE(toWhole(scan("nan")).fits);
}
