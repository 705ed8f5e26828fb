#include "server/http/cors.hpp"

#include <catch2/catch.hpp>

using namespace stipple::server;

namespace {

std::string origin(std::string_view text) {
    auto parsed = parseOrigin(text);
    return parsed ? *parsed : "refused";
}

HttpResponse completed(const CorsRules& rules, const char* from, bool isForAll) {
    HttpRequest request{"GET", "/", 11, {}};
    if (from != nullptr)
        request.fields.emplace_back("Origin", from);
    HttpResponse response;
    rules.complete(request, response, isForAll);
    return response;
}

CorsRules listing(const std::vector<std::string>& origins) {
    auto rules = CorsRules::listing(origins);
    REQUIRE(rules.ok());
    return *rules;
}

} // namespace

TEST_CASE("origins are read as browsers write them") {
    CHECK(origin("https://example.org") == "https://example.org");
    CHECK(origin("HTTPS://Example.ORG") == "https://example.org");
    CHECK(origin("https://example.org:443") == "https://example.org");
    CHECK(origin("http://example.org:443") == "http://example.org:443");
    CHECK(origin("http://localhost:8080") == "http://localhost:8080");
    CHECK(origin("http://127.0.0.1:80") == "http://127.0.0.1");
    CHECK(origin("http://[::1]:8080") == "http://[::1]:8080");
    CHECK(origin("http://[::1]") == "http://[::1]");
}

TEST_CASE("what is no origin is refused") {
    for (const char* text : {"",
                             "example.org",
                             "https://",
                             "https://a/",
                             "https://a/b",
                             "ftp://a",
                             "null",
                             "https://a:",
                             "https://a:x",
                             "https://a:0",
                             "https://a:65536",
                             "https://a:080",
                             "https://a b",
                             "https://a,https://b",
                             "https://u@a",
                             "https://*.a",
                             "https://[::1",
                             "https://[]",
                             "https://[::1]x",
                             "https://a\r\nX: y",
                             "https://a?b"}) {
        INFO(text);
        CHECK(origin(text) == "refused");
        CHECK_FALSE(CorsRules::listing({text}).ok());
    }
}

TEST_CASE("what is for everybody is for every origin, and does not vary") {
    for (const CorsRules& rules : {CorsRules(), listing({"https://a"}), listing({"*"})})
        for (const char* from : {static_cast<const char*>(nullptr), "https://a", "https://b", "null"}) {
            HttpResponse response = completed(rules, from, true);
            CHECK(response.field("Access-Control-Allow-Origin") == "*");
            CHECK(response.field("Vary").empty());
            CHECK(response.field("Access-Control-Expose-Headers").find("Content-Range") != std::string::npos);
        }
}

TEST_CASE("what is for everybody on this machine is for the listed origins alone") {
    auto rules = CorsRules::listing({"https://a"}, CorsRules::PublicFor::listedOrigins);
    REQUIRE(rules.ok());
    CHECK_FALSE(rules->isPublicForAll());
    for (bool isForAll : {true, false}) {
        CHECK(completed(*rules, "https://a", isForAll).field("Access-Control-Allow-Origin") == "https://a");
        CHECK(completed(*rules, "https://b", isForAll).field("Access-Control-Allow-Origin").empty());
        CHECK(completed(*rules, "https://b", isForAll).field("Vary") == "Origin");
    }
    auto all = CorsRules::listing({"*"}, CorsRules::PublicFor::listedOrigins);
    REQUIRE(all.ok());
    CHECK(all->isPublicForAll());
    CHECK(completed(*all, "https://b", true).field("Access-Control-Allow-Origin") == "*");
}

TEST_CASE("what needs credentials is for the listed origins alone") {
    CorsRules rules = listing({"https://a", "http://localhost:8080"});
    for (const char* from : {"https://a", "http://localhost:8080"}) {
        HttpResponse response = completed(rules, from, false);
        CHECK(response.field("Access-Control-Allow-Origin") == from);
        CHECK(response.field("Vary") == "Origin");
    }
    for (const char* from : {static_cast<const char*>(nullptr), "https://b", "http://a", "https://a.b",
                             "https://a:8080", "null", "*"}) {
        HttpResponse response = completed(rules, from, false);
        CHECK(response.field("Access-Control-Allow-Origin").empty());
        CHECK(response.field("Access-Control-Expose-Headers").empty());
        CHECK(response.field("Vary") == "Origin");
    }
    CHECK(completed(CorsRules(), "https://a", false).field("Access-Control-Allow-Origin").empty());
    CHECK(completed(listing({"*"}), "https://b", false).field("Access-Control-Allow-Origin") == "*");
}

TEST_CASE("Vary keeps what it had") {
    HttpRequest request{"GET", "/", 11, {}};
    HttpResponse response;
    response.set("Vary", "Accept");
    CorsRules().complete(request, response, false);
    CorsRules().complete(request, response, false);
    CHECK(response.field("Vary") == "Accept, Origin");
}

TEST_CASE("a preflight may send tokens and conditions") {
    HttpResponse response = preflightResponse("GET, HEAD");
    CHECK(response.status == 204);
    CHECK(response.field("Access-Control-Allow-Methods") == "GET, HEAD");
    CHECK(response.field("Access-Control-Allow-Headers").starts_with("Authorization, Range, If-Range"));
    CHECK(response.field("Access-Control-Max-Age") == "7200");
}
