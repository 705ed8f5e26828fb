// Status and fields of every kind of answer, over a socket, against golden texts.
#include "tests/http/support/raw_client.hpp"
#include "tests/http/support/test_server.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace stipple;
using namespace stipple::test;

namespace {

TestServer& shared() {
    static TestServer instance;
    return instance;
}

RawResponse ask(const std::string& requestLine, const std::string& fields = "") {
    return askOnce(shared().port(),
                   requestLine + " HTTP/1.1\nHost: localhost" + (fields.empty() ? "" : "\n" + fields));
}

std::string tagOf(const std::string& target) {
    return ask("HEAD " + target).field("etag");
}

const std::string cloudTarget = "/clouds/town.stipple";

} // namespace

TEST_CASE("a whole cloud is a 200 with its validators, open to every origin") {
    auto response = ask("GET " + cloudTarget);
    std::string file = readFile(shared().folder().cloud());
    CHECK(response.body == file);
    CHECK(golden(response) == "HTTP/1.1 200 OK\n"
                              "Server: stipple\n"
                              "ETag: <...>\n"
                              "Last-Modified: <...>\n"
                              "Cache-Control: no-cache\n"
                              "Accept-Ranges: bytes\n"
                              "Content-Type: application/octet-stream\n"
                              "Access-Control-Allow-Origin: *\n"
                              "Access-Control-Expose-Headers: Accept-Ranges, Content-Length, Content-Range, "
                              "ETag, Last-Modified\n"
                              "Cross-Origin-Resource-Policy: cross-origin\n"
                              "X-Content-Type-Options: nosniff\n"
                              "Content-Length: " +
                                  std::to_string(file.size()) + "\nConnection: keep-alive\n");
    CHECK_FALSE(response.field("date").empty());
}

TEST_CASE("a range of a cloud is a 206 that says which bytes of how many") {
    auto response = ask("GET " + cloudTarget, "Range: bytes=64-163");
    std::string file = readFile(shared().folder().cloud());
    CHECK(response.body == file.substr(64, 100));
    CHECK(golden(response) ==
          "HTTP/1.1 206 Partial Content\n"
          "Server: stipple\n"
          "ETag: <...>\n"
          "Last-Modified: <...>\n"
          "Cache-Control: no-cache\n"
          "Accept-Ranges: bytes\n"
          "Content-Type: application/octet-stream\n"
          "Content-Range: bytes 64-163/" +
              std::to_string(file.size()) +
              "\nAccess-Control-Allow-Origin: *\n"
              "Access-Control-Expose-Headers: Accept-Ranges, Content-Length, Content-Range, "
              "ETag, Last-Modified\n"
              "Cross-Origin-Resource-Policy: cross-origin\n"
              "X-Content-Type-Options: nosniff\n"
              "Content-Length: 100\nConnection: keep-alive\n");
}

TEST_CASE("open-ended and suffix ranges reach the end") {
    std::string file = readFile(shared().folder().cloud());
    std::string size = std::to_string(file.size());
    auto open = ask("GET " + cloudTarget, "Range: bytes=1000-");
    CHECK(open.status == 206);
    CHECK(open.body == file.substr(1000));
    auto suffix = ask("GET " + cloudTarget, "Range: bytes=-10");
    CHECK(suffix.status == 206);
    CHECK(suffix.body == file.substr(file.size() - 10));
    CHECK(suffix.field("content-range") ==
          "bytes " + std::to_string(file.size() - 10) + "-" + std::to_string(file.size() - 1) + "/" + size);
}

TEST_CASE("several ranges come as multipart/byteranges, also when the parts are large") {
    auto response = ask("GET /pattern.bin", "Range: bytes=1000000-1299999,5-8,-2");
    CHECK(response.status == 206);
    CHECK(response.isComplete);
    std::string type = response.field("content-type");
    std::string boundary = type.substr(type.find("boundary=") + 9);
    auto part = [&](std::uint64_t first, std::uint64_t last) {
        std::string text = "--" + boundary +
                           "\r\nContent-Type: application/octet-stream\r\nContent-Range: bytes " +
                           std::to_string(first) + "-" + std::to_string(last) + "/3000000\r\n\r\n";
        for (std::uint64_t at = first; at <= last; ++at)
            text += patternByte(at);
        return text + "\r\n";
    };
    bool same = response.body ==
                part(1000000, 1299999) + part(5, 8) + part(2999998, 2999999) + "--" + boundary + "--\r\n";
    CHECK(same);
}

TEST_CASE("large ranges arrive byte for byte, wherever they begin and end") {
    RawClient client(shared().port());
    for (auto [first, size] : {std::pair{0ull, 1ull},
                               {0, 65535},
                               {0, 65536},
                               {0, 65537},
                               {1, 262144},
                               {7, 327680},
                               {7, 327681},
                               {12345, 2'000'000},
                               {0, 3'000'000},
                               {2'999'999, 1}}) {
        auto response =
            client.ask("GET /pattern.bin HTTP/1.1\nHost: a\nRange: bytes=" + std::to_string(first) + "-" +
                       std::to_string(first + size - 1));
        REQUIRE(response.status == 206);
        REQUIRE(response.body.size() == size);
        std::uint64_t wrong = 0;
        for (std::uint64_t i = 0; i < size; ++i)
            wrong += response.body[i] != patternByte(first + i);
        CHECK(wrong == 0);
    }
}

TEST_CASE("ranges around 2^31, 2^32, 2^63 and 2^64 are exact") {
    auto huge = [](const std::string& range) {
        auto response = ask("GET /huge.bin", "Range: bytes=" + range);
        return std::to_string(response.status) + " " + response.field("content-range") + " " +
               (response.status == 206 ? response.body : "");
    };
    std::string zero(1, '\0');
    CHECK(huge("2147483646-2147483649") == "206 bytes 2147483646-2147483649/5368709127 MARK");
    CHECK(huge("4294967294-4294967297") == "206 bytes 4294967294-4294967297/5368709127 MARK");
    CHECK(huge("4294967293-4294967293") == "206 bytes 4294967293-4294967293/5368709127 " + zero);
    CHECK(huge("5368709123-9223372036854775807") == "206 bytes 5368709123-5368709126/5368709127 MARK");
    CHECK(huge("5368709123-9223372036854775808") == "206 bytes 5368709123-5368709126/5368709127 MARK");
    CHECK(huge("5368709123-18446744073709551615") == "206 bytes 5368709123-5368709126/5368709127 MARK");
    CHECK(huge("5368709123-18446744073709551616") == "206 bytes 5368709123-5368709126/5368709127 MARK");
    CHECK(huge("-4") == "206 bytes 5368709123-5368709126/5368709127 MARK");
    CHECK(huge("5368709127-") == "416 bytes */5368709127 ");
    CHECK(huge("18446744073709551616-") == "416 bytes */5368709127 ");
    CHECK(huge("-0") == "416 bytes */5368709127 ");
    CHECK(huge("5-4") == "416 bytes */5368709127 ");
    CHECK(huge("abc") == "416 bytes */5368709127 "); // no 5 GB by a typing error
}

TEST_CASE("an empty file has no satisfiable range") {
    auto whole = ask("GET /empty.txt");
    CHECK(whole.status == 200);
    CHECK(whole.field("content-length") == "0");
    for (const char* range : {"0-", "0-0", "-1", "-0"})
        CHECK(ask("GET /empty.txt", std::string("Range: bytes=") + range).field("content-range") ==
              "bytes */0");
}

TEST_CASE("unknown units are ignored, and too many ranges refused") {
    CHECK(ask("GET " + cloudTarget, "Range: points=0-9").status == 200);
    std::string many = "Range: bytes=0-0";
    for (int i = 1; i < 100; ++i)
        many += "," + std::to_string(i * 1000) + "-" + std::to_string(i * 1000);
    CHECK(ask("GET /pattern.bin", many).status == 416);
}

TEST_CASE("a range outside the file is a 416 problem that names the size and the version") {
    auto response = ask("GET " + cloudTarget, "Range: bytes=99999999-");
    std::string size = std::to_string(readFile(shared().folder().cloud()).size());
    CHECK(golden(response) ==
          "HTTP/1.1 416 Range Not Satisfiable\n"
          "Server: stipple\n"
          "Content-Type: application/problem+json\n"
          "Cache-Control: no-store\n"
          "ETag: <...>\n"
          "Last-Modified: <...>\n"
          "Accept-Ranges: bytes\n"
          "Content-Range: bytes */" +
              size +
              "\nAccess-Control-Allow-Origin: *\n"
              "Access-Control-Expose-Headers: Accept-Ranges, Content-Length, Content-Range, "
              "ETag, Last-Modified\n"
              "Cross-Origin-Resource-Policy: cross-origin\n"
              "X-Content-Type-Options: nosniff\n"
              "Content-Length: " +
              std::to_string(response.body.size()) + "\nConnection: keep-alive\n");
    auto problem = nlohmann::json::parse(response.body, nullptr, false);
    CHECK(problem["status"] == 416);
    CHECK(problem["title"] == "Range Not Satisfiable");
    CHECK(problem["detail"].is_string());
}

TEST_CASE("conditions are answered by version") {
    std::string tag = tagOf(cloudTarget);
    REQUIRE(tag.size() > 2);
    auto notModified = ask("GET " + cloudTarget, "If-None-Match: \"x\", " + tag);
    CHECK(golden(notModified) ==
          "HTTP/1.1 304 Not Modified\n"
          "Server: stipple\n"
          "ETag: <...>\n"
          "Last-Modified: <...>\n"
          "Cache-Control: no-cache\n"
          "Accept-Ranges: bytes\n"
          "Access-Control-Allow-Origin: *\n"
          "Access-Control-Expose-Headers: Accept-Ranges, Content-Length, Content-Range, "
          "ETag, Last-Modified\n"
          "Cross-Origin-Resource-Policy: cross-origin\n"
          "X-Content-Type-Options: nosniff\n"
          "Connection: keep-alive\n");
    CHECK(ask("HEAD " + cloudTarget, "If-None-Match: " + tag).status == 304);
    auto failed = ask("GET " + cloudTarget, "If-Match: \"old\"\nRange: bytes=0-9");
    CHECK(failed.status == 412);
    CHECK(failed.field("etag") == tag);
    CHECK(failed.field("access-control-allow-origin") == "*");
    CHECK(ask("GET " + cloudTarget, "If-Match: " + tag + "\nRange: bytes=0-9").status == 206);
    CHECK(ask("GET " + cloudTarget, "If-Range: " + tag + "\nRange: bytes=0-9").status == 206);
    CHECK(ask("GET " + cloudTarget, "If-Range: \"old\"\nRange: bytes=0-9").status == 200);
    std::string date = ask("HEAD " + cloudTarget).field("last-modified");
    CHECK(ask("GET " + cloudTarget, "If-Modified-Since: " + date).status == 304);
    CHECK(ask("GET " + cloudTarget, "If-Unmodified-Since: " + date).status == 200);
    CHECK(ask("GET " + cloudTarget, "If-Unmodified-Since: Sun, 06 Nov 1994 08:49:37 GMT").status == 412);
}

TEST_CASE("HEAD says what GET would, without the body and without the range") {
    auto head = ask("HEAD " + cloudTarget, "Range: bytes=0-9");
    auto get = ask("GET " + cloudTarget);
    CHECK(golden(head) == golden(get));
    CHECK(head.status == 200);
    RawClient client(shared().port());
    CHECK(client.ask("HEAD /none HTTP/1.1\nHost: a").status == 404);
    CHECK(client.ask("GET / HTTP/1.1\nHost: a").status == 200); // nothing of a body was in between
}

TEST_CASE("a preflight is answered for every address") {
    auto response =
        ask("OPTIONS " + cloudTarget, "Origin: https://example.org\nAccess-Control-Request-Method: GET\n"
                                      "Access-Control-Request-Headers: range, if-match");
    CHECK(golden(response) == "HTTP/1.1 204 No Content\n"
                              "Server: stipple\n"
                              "Allow: GET, HEAD, OPTIONS\n"
                              "Access-Control-Allow-Methods: GET, HEAD, OPTIONS\n"
                              "Access-Control-Allow-Headers: Range, If-Range, If-Match, If-None-Match, "
                              "If-Modified-Since, If-Unmodified-Since\n"
                              "Access-Control-Max-Age: 7200\n"
                              "Access-Control-Allow-Origin: *\n"
                              "Access-Control-Expose-Headers: Accept-Ranges, Content-Length, Content-Range, "
                              "ETag, Last-Modified\n"
                              "Cross-Origin-Resource-Policy: cross-origin\n"
                              "X-Content-Type-Options: nosniff\n"
                              "Connection: keep-alive\n");
    CHECK(ask("OPTIONS *").status == 204);
}

TEST_CASE("other methods are refused with the allowed ones, unknown ones as such") {
    for (const char* method : {"POST", "PUT", "DELETE", "PATCH", "TRACE"}) {
        auto response = ask(std::string(method) + " " + cloudTarget, "Content-Length: 0");
        CHECK(response.status == 405);
        CHECK(response.field("allow") == "GET, HEAD, OPTIONS");
        CHECK(response.field("access-control-allow-origin") == "*");
    }
    CHECK(ask("BREW " + cloudTarget).status == 501);
    CHECK(ask("get " + cloudTarget).status == 501);
}

TEST_CASE("the list of clouds says what each is and where") {
    auto response = ask("GET /api/v1/clouds");
    CHECK(response.status == 200);
    CHECK(response.field("content-type") == "application/json");
    auto json = nlohmann::json::parse(response.body, nullptr, false);
    REQUIRE(json["clouds"].size() == 1);
    auto& cloud = json["clouds"][0];
    CHECK(cloud["id"] == "town");
    CHECK(cloud["name"] == "Town");
    CHECK(cloud["address"] == cloudTarget);
    CHECK(cloud["pointCount"] == 20'000);
    CHECK(cloud["sizeBytes"] == readFile(shared().folder().cloud()).size());
    CHECK(cloud["etag"] == tagOf(cloudTarget));
    CHECK(cloud["bounds"]["max"][0].get<double>() <= 1048.575);
    CHECK(ask("GET /api/v1/clouds", "If-None-Match: " + response.field("etag")).status == 304);
}

TEST_CASE("one cloud's document holds the metadata of its file") {
    auto response = ask("GET /api/v1/clouds/town");
    auto json = nlohmann::json::parse(response.body, nullptr, false);
    CHECK(json["id"] == "town");
    CHECK(json["metadata"]["rootCube"]["bits"] == 20);
    CHECK(json["metadata"]["pointCount"] == 20'000);
}

TEST_CASE("what does not exist is a 404 problem, readable by other origins") {
    for (const char* target : {"/api/v1/clouds/none", "/clouds/none.stipple", "/clouds/town", "/clouds/",
                               "/api/v2", "/api/v1/clouds/town/x", "/none.html", "/assets", "/assets/"}) {
        INFO(target);
        auto response = ask(std::string("GET ") + target);
        CHECK(response.status == 404);
        CHECK(response.field("content-type") == "application/problem+json");
        CHECK(response.field("access-control-allow-origin") == "*");
    }
}

TEST_CASE("the page has content types, revalidation, immutable assets and a policy that lets it work") {
    auto index = ask("GET /");
    CHECK(index.status == 200);
    CHECK(index.field("content-type") == "text/html; charset=utf-8");
    CHECK(index.field("cache-control") == "no-cache");
    std::string policy = index.field("content-security-policy");
    CHECK(policy.find("'wasm-unsafe-eval'") != std::string::npos);
    CHECK(policy.find("worker-src 'self' blob:") != std::string::npos);
    CHECK(index.field("x-content-type-options") == "nosniff");
    CHECK(ask("GET /", "If-None-Match: " + index.field("etag")).status == 304);
    CHECK(ask("GET /index.html").body == index.body);
    CHECK(ask("GET /core.wasm").field("content-type") == "application/wasm");
    auto asset = ask("GET /assets/app-A1b2C3d4.js");
    CHECK(asset.field("content-type") == "text/javascript; charset=utf-8");
    CHECK(asset.field("cache-control") == "public, max-age=31536000, immutable");
}

TEST_CASE("no path leads out of the page folder") {
    for (const char* target :
         {"/../secret.txt", "/%2e%2e/secret.txt", "/..%2fsecret.txt", "/assets/../../secret.txt", "/link.txt",
          "/%2e%2e%5csecret.txt", "/..\\secret.txt", "//etc/passwd", "/%2fetc/passwd", "/index.html%00.js",
          "/clouds/../secret.txt", "/clouds/..%2f..%2fsecret.txt", "/.git/config", "/%"}) {
        INFO(target);
        auto response = ask(std::string("GET ") + target);
        CHECK((response.status == 400 || response.status == 404));
        CHECK(response.body.find("secret\n") == std::string::npos);
        CHECK(response.field("content-type") == "application/problem+json");
    }
}
