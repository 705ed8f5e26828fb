#include "shared/io/http_date.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

namespace {
constexpr std::int64_t example = 784111777; // the date of RFC 9110 §5.6.7
constexpr std::int64_t now = 1'700'000'000; // 2023
} // namespace

TEST_CASE("dates are written as IMF-fixdate") {
    CHECK(httpDate(example) == "Sun, 06 Nov 1994 08:49:37 GMT");
    CHECK(httpDate(0) == "Thu, 01 Jan 1970 00:00:00 GMT");
    CHECK(httpDate(951782400) == "Tue, 29 Feb 2000 00:00:00 GMT");
    CHECK(httpDate(-1) == "Wed, 31 Dec 1969 23:59:59 GMT");
}

TEST_CASE("all three forms of a date are read") {
    CHECK(parseHttpDate("Sun, 06 Nov 1994 08:49:37 GMT", now) == example);
    CHECK(parseHttpDate("Sunday, 06-Nov-94 08:49:37 GMT", now) == example);
    CHECK(parseHttpDate("Sun Nov  6 08:49:37 1994", now) == example);
}

TEST_CASE("a two-digit year is at most 50 years ahead") {
    CHECK(httpDate(*parseHttpDate("Sunday, 06-Nov-73 08:49:37 GMT", now)) == "Mon, 06 Nov 2073 08:49:37 GMT");
    CHECK(httpDate(*parseHttpDate("Sunday, 06-Nov-74 08:49:37 GMT", now)) == "Wed, 06 Nov 1974 08:49:37 GMT");
}

TEST_CASE("every day of 400 years survives writing and reading") {
    for (std::int64_t day = -135140; day < 10957; ++day) { // from 1600 to 2000
        std::int64_t seconds = day * 86400 + 86399;
        if (parseHttpDate(httpDate(seconds), now) != seconds)
            FAIL(httpDate(seconds));
    }
}

TEST_CASE("what is no date is not read") {
    for (const char* text :
         {"", "now", "Sun, 06 Nov 1994 08:49:37", "Sun, 6 Nov 1994 08:49:37 GMT",
          "Sun, 06 Nov 1994 24:49:37 GMT", "Sun, 00 Nov 1994 08:49:37 GMT", "Sun, 06 Non 1994 08:49:37 GMT",
          "Sun, 06 Nov 1994 08:49:37 GMT ", "784111777"}) {
        INFO(text);
        CHECK_FALSE(parseHttpDate(text, now));
    }
}
