#include "shared/base/phrase.hpp"

#include "shared/base/result.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

TEST_CASE("a phrase is English text that knows its values") {
    std::string name = "town";
    const char* unit = "bytes";
    Phrase phrase = say("the header of ", name, " ends after ", 12, " of ", 128.5, " ", unit, ": ", true);
    CHECK(phrase.text() == "the header of town ends after 12 of 128.5 bytes: true");
    CHECK(phrase.marked() == "the header of \x02"
                             "town\x03 ends after \x02"
                             "12\x03 of \x02"
                             "128.5\x03 \x02"
                             "bytes\x03: \x02"
                             "true\x03");
    CHECK(phrase == "the header of town ends after 12 of 128.5 bytes: true");
    CHECK(Phrase(phrase.marked()).text() == phrase.text());
}

TEST_CASE("values may be phrases, and hold no marks of their own") {
    Phrase outer = say("'", "size", "' ", say("must be at most ", 64));
    CHECK(outer.text() == "'size' must be at most 64");
    CHECK(outer.marked() == "'size' \x02must be at most \x02"
                            "64\x03\x03");
    CHECK(say("no ", std::string("a\x02"
                                 "b\x03"))
              .marked() == "no \x02"
                           "ab\x03");
    CHECK(Phrase().empty());
    CHECK(Phrase("plain").marked() == "plain");
}

TEST_CASE("an error is said field by field, and in English as before") {
    Error error{ErrorCode::truncated, say("the file ends before byte ", 7), "a.stipple",
                say("copy it again")};
    CHECK(error.sentence() == "a.stipple: the file ends before byte 7 (copy it again)");
    CHECK(error.said() == "a.stipple\x1ethe file ends before byte \x02"
                          "7\x03\x1e"
                          "copy it again");
    CHECK(error.at("b").said().starts_with("b, a.stipple\x1e"));
}
