#include "server/http/target.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::server;

namespace {

// Segments in brackets, then the query; "refused" for an error.
std::string parsed(std::string_view text) {
    auto target = parseTarget(text);
    if (!target)
        return "refused";
    std::string shown;
    for (const std::string& segment : target->segments)
        shown += "[" + segment + "]";
    return target->query.empty() ? shown : shown + "?" + target->query;
}

} // namespace

TEST_CASE("a path is its decoded segments") {
    CHECK(parsed("/") == "");
    CHECK(parsed("/a/b.c") == "[a][b.c]");
    CHECK(parsed("/a/") == "[a][]");
    CHECK(parsed("/a%20b/%C3%A4") == "[a b][\xC3\xA4]");
    CHECK(parsed("/%2541") == "[%41]"); // decoded once
    CHECK(parsed("/a?b=%2e%2e/&c") == "[a]?b=%2e%2e/&c");
    CHECK(parsed("/?q") == "?q");
    CHECK(parsed("/...") == "[...]");
}

TEST_CASE("the absolute form is its path") {
    CHECK(parsed("http://host/a/b?c") == "[a][b]?c");
    CHECK(parsed("HTTP://host:80/a") == "[a]");
    CHECK(parsed("http://host") == "");
    CHECK(parsed("http:///a") == "refused");
    CHECK(parsed("http://host?q") == "refused");
    CHECK(parsed("HTTPS://host:8443/a%20b") == "[a b]");
}

TEST_CASE("paths that could be read in two ways are refused") {
    for (const char* text :
         {"",        "*",      "a",         "host:80", "https://",   "http://", "/..",    "/../etc/passwd",
          "/a/../b", "/a/./b", "/%2e%2e/x", "/.%2E/x", "/%2e",       "/a%2fb",  "/a%2Fb", "/..%2f..%2fetc",
          "/a\\b",   "/a%5cb", "/a%5C..",   "/%00",    "/a%00.html", "/%0a",    "/%1f",   "/%7f",
          "/\x01",   "/a\x7F", "/%",        "/%4",     "/a%4",       "/%zz",    "/%4g",   "/%-1",
          "//",      "//a",    "/a//b",     "/a#b",    "/%c0%ae%00"}) {
        INFO(text);
        CHECK(parsed(text) == "refused");
    }
    CHECK(parsed(std::string_view("/a\0b", 4)) == "refused");
}

TEST_CASE("overlong encodings of dots stay bytes and name nothing special") {
    CHECK(parsed("/%c0%ae%c0%ae/x") == "[\xC0\xAE\xC0\xAE][x]");
}

TEST_CASE("encoding a segment and decoding it gives it back") {
    std::string segment;
    for (int byte = 0x20; byte < 0x100; ++byte)
        if (byte != '/' && byte != '\\' && byte != 0x7F)
            segment += static_cast<char>(byte);
    auto target = parseTarget("/" + percentEncoded(segment));
    REQUIRE(target);
    CHECK(target->segments == std::vector<std::string>{segment});
}
