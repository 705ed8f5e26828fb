#include "server/log/access_log.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace stipple::server;

namespace {

RequestRecord record() {
    RequestRecord made;
    made.timeMs = 1'769'860'800'123; // 2026-01-31 12:00:00.123 UTC
    made.client = "127.0.0.1";
    made.method = "GET";
    made.target = "/clouds/town.stipple";
    made.range = "bytes=0-65535";
    made.userAgent = "curl/8";
    made.status = 206;
    made.bodyBytes = 65536;
    made.milliseconds = 0.5;
    return made;
}

const std::string secret = "uGZzabcdefghijklmnopqrstuvwxyz0123456789-_A";

} // namespace

TEST_CASE("a combined line is what log analysers read") {
    RequestRecord made = record();
    CHECK(
        combinedLine(made) ==
        R"(127.0.0.1 - - [31/Jan/2026:12:00:00 +0000] "GET /clouds/town.stipple HTTP/1.1" 206 65536 "-" "curl/8")");
    made.user = "Lisa M";
    made.referer = "https://maps.example/a?cloud=x#y";
    made.version = 10;
    made.bodyBytes = 0;
    CHECK(
        combinedLine(made) ==
        R"(127.0.0.1 - Lisa\x20M [31/Jan/2026:12:00:00 +0000] "GET /clouds/town.stipple HTTP/1.0" 206 - "https://maps.example/a" "curl/8")");
    RequestRecord unreadable;
    unreadable.status = 400;
    CHECK(combinedLine(unreadable) == R"(- - - [01/Jan/1970:00:00:00 +0000] "-" 400 - "-" "-")");
}

TEST_CASE("a JSON line has every member, in order") {
    CHECK(jsonLine(record()) ==
          R"({"time":"2026-01-31T12:00:00.123Z","client":"127.0.0.1","user":"","method":"GET",)"
          R"("target":"/clouds/town.stipple","version":"1.1","range":"bytes=0-65535","referer":"",)"
          R"("userAgent":"curl/8","job":"","status":206,"bytes":65536,"milliseconds":0.5,"complete":true})");
}

TEST_CASE("nothing that a client sends makes a line of its own or reaches a terminal") {
    std::string nasty;
    for (int c = 0; c < 256; ++c)
        nasty += static_cast<char>(c);
    RequestRecord made = record();
    made.method = made.target = made.range = made.referer = made.userAgent = made.user = nasty;
    for (const std::string& line : {combinedLine(made), jsonLine(made)}) {
        INFO(line);
        CHECK(std::all_of(line.begin(), line.end(), [](unsigned char c) { return c >= 0x20 && c < 0x7F; }));
    }
    CHECK(nlohmann::json::parse(jsonLine(made), nullptr, false).is_object());
    // What is in quotes has no quote.
    std::string combined = combinedLine(made);
    CHECK(std::count(combined.begin(), combined.end(), '"') == 6);
}

TEST_CASE("long texts are cut") {
    RequestRecord made = record();
    made.target = made.userAgent = std::string(100'000, 'a');
    CHECK(combinedLine(made).size() < 3000);
    CHECK(jsonLine(made).size() < 3000);
}

TEST_CASE("signatures and tokens are not in the log, however they are written") {
    for (const char* before :
         {"/clouds/a.stipple?expires=1&signature=", "/a?SIGNATURE=", "/a?token=", "/a?access_token=",
          "/?cloud=%2Fclouds%2Fa.stipple%3Fexpires%3D1%26signature%3D", "/?c=%253Fsignature%253d",
          "/?c=%25253Ftoken%25253D", "/stipple_", "/x?y=stipple_AAAAAAAA_"}) {
        INFO(before);
        CHECK(withoutSecrets(before + secret).find("uGZz") == std::string::npos);
        CHECK(withoutSecrets(before + secret).starts_with(std::string(before).substr(0, 4)));
        CHECK(withoutSecrets(before + secret + "&limit=3").find("&limit=3") != std::string::npos);
    }
    CHECK(withoutSecrets("/a?x=1&signature=" + secret + "&y=2") == "/a?x=1&signature=...&y=2");
    CHECK(withoutSecrets("/?c=%3Fsignature%3D" + secret + "%26y%3D2") == "/?c=%3Fsignature%3D...%26y%3D2");
    RequestRecord made = record();
    made.target = "/clouds/a.stipple?signature=" + secret;
    made.referer = "https://maps.example/?signature=" + secret;
    made.userAgent = "token=" + secret;
    for (const std::string& line : {combinedLine(made), jsonLine(made)})
        CHECK(line.find("uGZz") == std::string::npos);
}

TEST_CASE("what is no secret stays as it is") {
    for (const char* text : {"", "/", "/clouds/signature.stipple", "/a?signatures", "/a?b=token", "%", "%2",
                             "%25", "token%", "token%3", "/clouds/stippled.stipple"})
        CHECK(withoutSecrets(text) == text);
}
