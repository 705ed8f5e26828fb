#include "shared/io/retry_after.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

namespace {

constexpr std::int64_t now = 784111777; // Sun, 06 Nov 1994 08:49:37 GMT

} // namespace

TEST_CASE("a date, in each of its forms, is so many seconds after the answer's own") {
    const char* own = "Sun, 06 Nov 1994 08:49:30 GMT";
    CHECK(retryAfterInSeconds("Sun, 06 Nov 1994 08:49:37 GMT", own, now + 5000) == "7");
    CHECK(retryAfterInSeconds("Sunday, 06-Nov-94 08:50:30 GMT", own, now + 5000) == "60");
    CHECK(retryAfterInSeconds("Sun Nov  6 09:49:30 1994", own, now + 5000) == "3600");
    CHECK(retryAfterInSeconds("Sun, 06 Nov 1994 08:49:29 GMT", own, now - 5000) == "0");
}

TEST_CASE("without a date of the answer the machine's clock counts") {
    for (const char* none : {"", "yesterday", "Sun, 06 Nov 1994"})
        CHECK(retryAfterInSeconds("Sun, 06 Nov 1994 08:50:00 GMT", none, now) == "23");
}

TEST_CASE("what is no date stays as it is") {
    for (const char* text : {"", "7", "-1", "1.5", "99999999999", "Sun, 32 Nov 1994 08:49:37 GMT", "soon"})
        CHECK(retryAfterInSeconds(text, "Sun, 06 Nov 1994 08:49:30 GMT", now) == text);
}
