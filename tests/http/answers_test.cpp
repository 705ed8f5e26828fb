// What answers hold, over a socket: bytes, documents, and what must not be there. Their fields are in
// golden/.
#include "tests/http/support/raw_client.hpp"
#include "tests/http/support/test_server.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
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

TEST_CASE("a whole cloud is its file") {
    auto response = ask("GET " + cloudTarget);
    std::string file = readFile(shared().folder().cloud());
    CHECK(response.body == file);
    CHECK_FALSE(response.field("date").empty());
}

TEST_CASE("a range of a cloud is exactly those bytes") {
    auto response = ask("GET " + cloudTarget, "Range: bytes=64-163");
    std::string file = readFile(shared().folder().cloud());
    CHECK(response.body == file.substr(64, 100));
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

TEST_CASE("conditions are answered by version") {
    std::string tag = tagOf(cloudTarget);
    REQUIRE(tag.size() > 2);
    auto notModified = ask("GET " + cloudTarget, "If-None-Match: \"x\", " + tag);
    CHECK(notModified.status == 304);
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
    CHECK(ask("GET " + cloudTarget, "If-Unmodified-Since: Sat, 05 Nov 1994 08:49:37 GMT").status == 412);
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

TEST_CASE("the page has content types, revalidation, immutable assets and a policy that lets it work") {
    auto index = ask("GET /");
    CHECK(index.status == 200);
    CHECK(index.field("content-type") == "text/html; charset=utf-8");
    CHECK(index.field("cache-control") == "no-cache");
    std::string policy = index.field("content-security-policy");
    CHECK(policy.find("'wasm-unsafe-eval'") != std::string::npos);
    CHECK(policy.find("worker-src 'self'") != std::string::npos);
    CHECK(policy.find("worker-src 'self' blob:") == std::string::npos);
    CHECK(index.field("x-content-type-options") == "nosniff");
    CHECK(ask("GET /", "If-None-Match: " + index.field("etag")).status == 304);
    CHECK(ask("GET /index.html").body == index.body);
    CHECK(ask("GET /core.wasm").field("content-type") == "application/wasm");
    auto asset = ask("GET /assets/app-A1b2C3d4.js");
    CHECK(asset.field("content-type") == "text/javascript; charset=utf-8");
    CHECK(asset.field("cache-control") == "public, max-age=31536000, immutable");
}

TEST_CASE("nothing follows the head of an answer to HEAD") {
    RawClient client(shared().port());
    CHECK(client.ask("HEAD /none HTTP/1.1\nHost: a").status == 404);
    CHECK(client.ask("HEAD /letters.txt HTTP/1.1\nHost: a").status == 200);
    CHECK(client.ask("GET /letters.txt HTTP/1.1\nHost: a").body == "abcdefghijklmnopqrstuvwxyz");
}

// What has led out of the folders of other servers: dot segments plain, encoded once and twice, in overlong
// UTF-8 and as UTF-16 escapes; slashes and backslashes of every kind; NUL and line ends; drive letters and
// streams; parameters of segments; absolute forms; hidden files; links.
TEST_CASE("no path leads out of the page folder, or to a hidden file") {
    std::vector<std::string> targets{
        "/link.txt", "/.git/config", "/assets/.hidden", "/secret.txt", "/..", "/../", "/."};
    for (const char* dots : {"..",
                             "%2e%2e",
                             "%2E%2E",
                             ".%2e",
                             "%2e.",
                             "%252e%252e",
                             "%c0%ae%c0%ae",
                             "%e0%80%ae%e0%80%ae",
                             "%u002e%u002e",
                             "..;",
                             "..;x=1",
                             "...",
                             "....",

                             "..%20",
                             "..%00",
                             "..%0d%0a",
                             "%uff0e%uff0e",
                             "%ef%bc%8e%ef%bc%8e",
                             "..::$DATA",
                             "C:",
                             "~"})
        for (const char* slash : {"/", "%2f", "%2F", "\\", "%5c", "%252f", "%c0%af", "%e0%80%af", "%u2215",
                                  "//", "/./", "%ef%bc%8f"})
            for (const char* start : {"/", "/assets/", "/clouds/", "/api/v1/clouds/", "http://localhost/"})
                for (const char* name : {"secret.txt", "secret.txt.stipple"}) {
                    targets.push_back(std::string(start) + dots + slash + name);
                    targets.push_back(std::string(start) + dots + slash + dots + slash + name);
                }
    auto client = std::make_unique<RawClient>(shared().port());
    std::size_t wrong = 0;
    for (const std::string& target : targets) {
        auto response = client->ask("GET " + target + " HTTP/1.1\nHost: a");
        bool isRefused = (response.status == 400 || response.status == 404) &&
                         response.field("content-type") == "application/problem+json";
        if (!isRefused) {
            UNSCOPED_INFO(target << ": " << response.status);
            ++wrong;
        }
        if (response.field("connection") != "keep-alive") // a space in the target, say: no request at all
            client = std::make_unique<RawClient>(shared().port());
    }
    CHECK(wrong == 0);
    CHECK(targets.size() > 5000);
}

TEST_CASE("a long list of clouds comes in pages, each once, in order") {
    TestServer server(TestServer::quickLimits(), [](TestFolder& folder) {
        for (int i = 100; i < 350; ++i)
            std::filesystem::create_hard_link(folder.cloud(),
                                              folder.clouds() / (std::to_string(i) + ".stipple"));
        std::ofstream(folder.clouds() / "111-broken.stipple") << "nonsense";
        return server::SiteOptions();
    });
    for (int round = 0; round < 2; ++round) { // opened by jobs, then known
        std::vector<std::string> ids;
        std::string next = "/api/v1/clouds?limit=70";
        for (int page = 0; !next.empty(); ++page) {
            REQUIRE(page < 5);
            auto response = askOnce(server.port(), "GET " + next + " HTTP/1.1\nHost: a");
            REQUIRE(response.status == 200);
            auto json = nlohmann::json::parse(response.body, nullptr, false);
            for (const auto& cloud : json["clouds"])
                ids.push_back(cloud["id"]);
            next = json.value("next", "");
            CHECK(response.field("link") == (next.empty() ? "" : "<" + next + ">; rel=\"next\""));
        }
        CHECK(ids.size() == 251);
        CHECK(std::is_sorted(ids.begin(), ids.end()));
        CHECK(ids.back() == "town");
    }
    auto usual = nlohmann::json::parse(askOnce(server.port(), "GET /api/v1/clouds HTTP/1.1\nHost: a").body,
                                       nullptr, false);
    CHECK(usual["clouds"].size() == 99); // 100 but for the broken one
    auto asked = [&](const std::string& query) {
        return askOnce(server.port(), "GET /api/v1/clouds?" + query + " HTTP/1.1\nHost: a").status;
    };
    CHECK(asked("limit=1000&after=349") == 200);
    CHECK(asked("limit=0") == 400);
    CHECK(asked("limit=1001") == 400);
    CHECK(asked("limit=x") == 400);
    CHECK(asked("offset=3") == 400);
}

TEST_CASE("a list that jobs make heeds conditions") {
    TestServer server;
    auto list = askOnce(server.port(), "GET /api/v1/clouds HTTP/1.1\nHost: a");
    TestServer same; // nothing is known there yet
    auto again = askOnce(same.port(), "GET /api/v1/clouds HTTP/1.1\nHost: a\nIf-None-Match: *");
    CHECK(list.status == 200);
    CHECK(again.status == 304);
    CHECK(askOnce(server.port(), "GET /api/v1/clouds HTTP/1.1\nHost: a\nIf-None-Match: " + list.field("etag"))
              .status == 304);
}
