#include "server/access/id_pattern.hpp"

#include <catch2/catch.hpp>

using namespace stipple::server;

TEST_CASE("a pattern without a star is the id itself") {
    CHECK(matchesPattern("town", "town"));
    CHECK_FALSE(matchesPattern("town", "Town"));
    CHECK_FALSE(matchesPattern("town", "towns"));
    CHECK_FALSE(matchesPattern("town", "tow"));
    CHECK_FALSE(matchesPattern("", "town"));
}

TEST_CASE("a star stands for any run of characters, also none") {
    CHECK(matchesPattern("*", ""));
    CHECK(matchesPattern("*", "anything"));
    CHECK(matchesPattern("survey-*", "survey-2024"));
    CHECK(matchesPattern("survey-*", "survey-"));
    CHECK_FALSE(matchesPattern("survey-*", "survey"));
    CHECK(matchesPattern("*-2024", "survey-2023-2024"));
    CHECK(matchesPattern("a*b*c", "a-b-b-c"));
    CHECK(matchesPattern("a**c", "abc"));
    CHECK_FALSE(matchesPattern("a*b*c", "a-c-b"));
    CHECK_FALSE(matchesPattern("*a", "ab"));
}

TEST_CASE("a pattern made to be slow is not") {
    std::string id(2000, 'a'), pattern;
    for (int i = 0; i < 300; ++i)
        pattern += "a*";
    CHECK_FALSE(matchesPattern(pattern + "b", id));
}

TEST_CASE("patterns have the characters of ids and stars") {
    for (const char* good : {"town", "*", "a.b_c-D9*"})
        CHECK(isIdPattern(good));
    for (const char* bad : {"", "a b", "a/b", "ä", "a?", "a\n"})
        CHECK_FALSE(isIdPattern(bad));
    CHECK(matchesAny({"a", "b*"}, "bc"));
    CHECK_FALSE(matchesAny({}, "bc"));
}
