// Patterns of file names.
#include "converter/input/glob.hpp"

#include <catch2/catch.hpp>

#include <random>
#include <string>

using namespace stipple;

namespace {
// The definition, as slow as it comes: of patterns without brackets and names of single bytes.
bool matchesSlowly(std::string_view name, std::string_view pattern) {
    if (pattern.empty())
        return name.empty();
    if (pattern[0] == '*')
        return matchesSlowly(name, pattern.substr(1)) ||
               (!name.empty() && matchesSlowly(name.substr(1), pattern));
    return !name.empty() && (pattern[0] == '?' || pattern[0] == name[0]) &&
           matchesSlowly(name.substr(1), pattern.substr(1));
}
} // namespace

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

TEST_CASE("random patterns match as their definition says", "[glob]") {
    std::mt19937 random(5);
    auto text = [&](std::string_view alphabet) {
        std::string made;
        for (auto size = random() % 9; made.size() < size;)
            made += alphabet[random() % alphabet.size()];
        return made;
    };
    int matches = 0;
    for (int round = 0; round < 20000; ++round) {
        std::string name = text("ab"), pattern = text("ab*?");
        CAPTURE(name, pattern);
        bool expected = matchesSlowly(name, pattern);
        matches += expected ? 1 : 0;
        REQUIRE(matchesPattern(name, pattern) == expected);
    }
    CHECK(matches > 1000);
    // Any bytes at all do no harm.
    for (int round = 0; round < 20000; ++round)
        matchesPattern(text("a\xC3\xA4\xE6\xFF]"), text("a*?[]!^-\xC3\xA4\xE6\xFF"));
}
