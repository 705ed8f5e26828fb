// Patterns of file names.
#include "converter/input/glob.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace stipple;

TEST_CASE("a star is any characters, a question mark one, a bracket one of a set", "[glob]") {
    CHECK(matchesPattern("town.laz", "*.laz"));
    CHECK(matchesPattern("town.laz", "*"));
    CHECK(matchesPattern("town.laz", "t*n*z"));
    CHECK(matchesPattern("town.laz", "town.laz***"));
    CHECK(matchesPattern("town7.laz", "town?.laz"));
    CHECK(matchesPattern("town7.laz", "town[0-9].laz"));
    CHECK(matchesPattern("town].laz", "town[]].laz"));
    CHECK(matchesPattern("town-.laz", "town[a-].laz"));
    CHECK(matchesPattern("townx.laz", "town[!0-9].la[xyz]"));
    CHECK_FALSE(matchesPattern("town7.laz", "town[^0-9].laz"));
    CHECK_FALSE(matchesPattern("town.las", "*.laz"));
    CHECK_FALSE(matchesPattern("town.laz", "town?.laz"));
    CHECK_FALSE(matchesPattern("town.laz", "tow"));
    CHECK_FALSE(matchesPattern("", "?"));
    CHECK(matchesPattern("", "*"));
}

TEST_CASE("a bracket that is never closed is itself", "[glob]") {
    CHECK(matchesPattern("scan[1.laz", "scan[1.laz"));
    CHECK(matchesPattern("[", "["));
    CHECK_FALSE(matchesPattern("1", "[1"));
}

TEST_CASE("characters are those of UTF-8, and bytes that are not are themselves", "[glob]") {
    CHECK(matchesPattern("Straße.laz", "Stra?e.laz"));
    CHECK(matchesPattern("東京.laz", "??.laz"));
    CHECK(matchesPattern("ö.laz", "[ä-ü].laz"));
    CHECK(matchesPattern("a\xFFz", "a?z"));
    CHECK(matchesPattern("a\xFFz", "a\xFFz"));
    CHECK_FALSE(matchesPattern("a\xFFz", "a\xFEz"));
    CHECK_FALSE(matchesPattern("東.laz", "??.laz"));
}

TEST_CASE("hidden names fit only patterns that begin with a dot", "[glob]") {
    CHECK_FALSE(matchesPattern(".town.laz", "*"));
    CHECK_FALSE(matchesPattern(".town.laz", "?town.laz"));
    CHECK(matchesPattern(".town.laz", ".*"));
}

TEST_CASE("a pattern of many stars takes no time that grows with their number", "[glob]") {
    std::string pattern, name(2000, 'a');
    for (int i = 0; i < 200; ++i)
        pattern += "*a";
    CHECK(matchesPattern(name, pattern));
    CHECK_FALSE(matchesPattern(name, pattern + "b"));
}
