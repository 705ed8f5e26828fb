// Redirects and tokens of the native HTTP byte source: where it goes, how often, and who gets to see what.
#include "client/headless/http_redirect.hpp"
#include "client/headless/http_source.hpp"
#include "tests/http/support/scripted_http_server.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::test;

namespace {

Result<Bytes> readTen(const std::string& url, const HttpSourceOptions& options = {}) {
    auto source = openHttpSource(url, options);
    REQUIRE(source.ok());
    return readNow(**source, {0, 10});
}

std::string target(const std::string& from, const std::string& location) {
    auto base = parseHttpUrl(from);
    REQUIRE(base.ok());
    auto found = redirectTarget(*base, location, "here");
    return found ? originOf(*found) + found->target : "refused: " + found.error().what;
}

bool has(const std::string& header, const std::string& field) {
    return header.find("\r\n" + field + "\r\n") != std::string::npos;
}

} // namespace

TEST_CASE("a Location is resolved as any reference is") {
    const std::string base = "http://a.example/b/c/d.stipple?q";
    CHECK(target(base, "https://o.example/x?y=1#z") == "https://o.example:443/x?y=1");
    CHECK(target(base, "//o.example:81") == "http://o.example:81/");
    CHECK(target(base, "/x/./y/../z") == "http://a.example:80/x/z");
    CHECK(target(base, "x") == "http://a.example:80/b/c/x");
    CHECK(target(base, "./x/") == "http://a.example:80/b/c/x/");
    CHECK(target(base, "../x?y=../..") == "http://a.example:80/b/x?y=../..");
    CHECK(target(base, "../../../../x") == "http://a.example:80/x");
    CHECK(target(base, "..") == "http://a.example:80/b/");
    CHECK(target(base, "?other") == "http://a.example:80/b/c/d.stipple?other");
    CHECK(target("http://A.example:8017/x", "y") == "http://a.example:8017/y");
    CHECK(target(base, "") == "refused: the server redirects without saying where to");
    CHECK(target(base, "#x") == "refused: the server redirects without saying where to");
    for (const char* other :
         {"ftp://a/x", "file:///etc/passwd", "http://", "http://u@a/", "/a b", "/a\r\nX: y"})
        CHECK(target(base, other) == "refused: the server redirects to what is no http or https address");
    CHECK(target("https://a/x", "http://a/x") == "refused: the server redirects from https to http");
    CHECK(target("https://a/x", "/y") == "https://a:443/y");
}

TEST_CASE("every kind of redirect is followed, and the connections are used again") {
    for (const char* status : {"301 Moved Permanently", "302 Found", "303 See Other",
                               "307 Temporary Redirect", "308 Permanent Redirect"}) {
        INFO(status);
        ScriptedHttpServer there([](const std::string&) { return tenBytes(); });
        ScriptedHttpServer here(
            [&](const std::string&) { return redirectTo(there.origin() + "/elsewhere?x=1", status); });
        auto source = openHttpSource(here.origin() + "/a", {.connections = 1});
        REQUIRE(source.ok());
        for (int i = 0; i < 3; ++i) {
            auto bytes = readNow(**source, {0, 10});
            REQUIRE(bytes.ok());
            CHECK(std::string(bytes->begin(), bytes->end()) == "0123456789");
        }
        bool isPermanent = std::string(status).starts_with("301") || std::string(status).starts_with("308");
        CHECK(here.requests().size() == (isPermanent ? 1 : 3));
        REQUIRE(there.requests().size() == 3);
        CHECK(there.requests()[0].starts_with("GET /elsewhere?x=1 HTTP/1.1\r\n"));
        CHECK(has(there.requests()[0], "Range: bytes=0-9"));
        CHECK(has(there.requests()[2], "If-Match: \"v\""));
        CHECK(here.connections() == 1);
        CHECK(there.connections() == 1);
    }
}

TEST_CASE("redirects are bounded, and those that lead nowhere are errors") {
    int count = 0;
    ScriptedHttpServer circle([&](const std::string&) { return redirectTo("/" + std::to_string(++count)); });
    auto bytes = readTen(circle.origin() + "/a");
    REQUIRE_FALSE(bytes.ok());
    CHECK(bytes.error().sentence() == circle.origin() + "/a: the server redirects more than 5 times");
    CHECK(circle.requests().size() == 6);

    ScriptedHttpServer mute(
        [](const std::string&) { return std::string("HTTP/1.1 302 Found\r\nContent-Length: 0\r\n\r\n"); });
    CHECK(readTen(mute.origin() + "/a").error().code == ErrorCode::networkFailed);
    ScriptedHttpServer file([](const std::string&) { return redirectTo("file:///etc/passwd"); });
    CHECK(readTen(file.origin() + "/a").error().code == ErrorCode::networkFailed);
    std::string large = "HTTP/1.1 302 Found\r\nLocation: /b\r\nContent-Length: 100000000\r\n\r\n";
    ScriptedHttpServer wordy(
        [&](const std::string& header) { return header.starts_with("GET /a ") ? large : tenBytes(); });
    CHECK(readTen(wordy.origin() + "/a").ok()); // its body is not waited for
    CHECK(wordy.connections() == 2);
}

TEST_CASE("a token goes to its own origin, and not along with a redirect") {
    ScriptedHttpServer there([](const std::string&) { return tenBytes(); });
    ScriptedHttpServer here([&](const std::string& header) {
        return header.starts_with("GET /a ") ? redirectTo("/b") : redirectTo(there.origin() + "/c");
    });
    HttpSourceOptions options;
    std::string secret = "s3cret.token";
    auto originOfUrl = [](const std::string& url) { return originOf(*parseHttpUrl(url)); };
    options.tokenFor = [&](const std::string& origin) {
        return origin == originOfUrl(here.origin()) ? secret : std::string();
    };
    REQUIRE(readTen(here.origin() + "/a", options).ok());
    REQUIRE(here.requests().size() == 2);
    CHECK(has(here.requests()[0], "Authorization: Bearer s3cret.token"));
    CHECK(has(here.requests()[1], "Authorization: Bearer s3cret.token"));
    REQUIRE(there.requests().size() == 1);
    CHECK(there.requests()[0].find("uthorization") == std::string::npos);
    CHECK(there.requests()[0].find(secret) == std::string::npos);

    ScriptedHttpServer refusing([](const std::string&) {
        return std::string("HTTP/1.1 401 Unauthorized\r\nContent-Length: 0\r\n\r\n");
    });
    options.tokenFor = [&](const std::string&) { return secret; };
    auto refused = readTen(refusing.origin() + "/a", options);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().sentence().find(secret) == std::string::npos);
}
