#include "server/http/entity_tag.hpp"

#include <catch2/catch.hpp>

using namespace stipple::server;

TEST_CASE("a list of entity tags keeps each as it stands") {
    auto list = parseEntityTagList(R"("a", W/"b,c" ,, "")");
    REQUIRE(list);
    CHECK_FALSE(list->any);
    REQUIRE(list->tags.size() == 3);
    CHECK(list->tags[0] == "\"a\"");
    CHECK(list->tags[1] == "W/\"b,c\"");
    CHECK(list->tags[2] == "\"\"");
}

TEST_CASE("a star stands for any tag, alone only") {
    REQUIRE(parseEntityTagList(" * "));
    CHECK(parseEntityTagList(" * ")->any);
    CHECK_FALSE(parseEntityTagList(R"(*, "a")"));
}

TEST_CASE("malformed tag lists are no lists") {
    for (const char* text :
         {"", ",", "a", "\"a", "\"a\" \"b\"", "w/\"a\"", "W/a", "\"a b\"", "\"a\"b", "\"\x7F\""}) {
        INFO(text);
        CHECK_FALSE(parseEntityTagList(text));
    }
}

TEST_CASE("strong comparison refuses weak tags, weak comparison ignores the mark") {
    CHECK(strongMatch("\"a\"", "\"a\""));
    CHECK_FALSE(strongMatch("W/\"a\"", "W/\"a\""));
    CHECK_FALSE(strongMatch("\"a\"", "\"b\""));
    CHECK(weakMatch("W/\"a\"", "\"a\""));
    CHECK_FALSE(weakMatch("W/\"a\"", "\"b\""));
}

TEST_CASE("the tag of a text changes with the text") {
    CHECK(isStrongTag(tagOfText("")));
    CHECK(tagOfText("a") == tagOfText("a"));
    CHECK(tagOfText("a") != tagOfText("b"));
}
