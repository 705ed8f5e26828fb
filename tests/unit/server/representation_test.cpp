#include "server/http/representation.hpp"

#include <catch2/catch.hpp>

using namespace stipple::server;

namespace {

constexpr std::int64_t now = 1'700'000'000;

struct Answer {
    int status;
    std::string body;
    HttpResponse response;
    std::string field(std::string_view name) const { return response.field(name); }
};

Answer ask(const Representation& representation,
           std::vector<std::pair<std::string_view, std::string_view>> fields,
           std::string_view method = "GET") {
    HttpResponse response = answerRepresentation({method, "/", 11, std::move(fields)}, representation, now);
    std::string body;
    for (const BodyPart& part : response.body)
        body += std::get<std::string>(part);
    return {response.status, body, response};
}

Representation thousandBytes() {
    std::string text;
    for (int i = 0; i < 1000; ++i)
        text += static_cast<char>('a' + i % 26);
    Representation representation = Representation::ofText(text, "text/plain", "no-cache");
    representation.validators.lastModifiedSeconds = 784111777;
    return representation;
}

} // namespace

TEST_CASE("a plain GET answers the whole with its validators") {
    auto answer = ask(thousandBytes(), {});
    CHECK(answer.status == 200);
    CHECK(answer.body.size() == 1000);
    CHECK(answer.field("ETag") == thousandBytes().validators.etag);
    CHECK(answer.field("Last-Modified") == "Sun, 06 Nov 1994 08:49:37 GMT");
    CHECK(answer.field("Accept-Ranges") == "bytes");
    CHECK(answer.field("Content-Range").empty());
}

TEST_CASE("one range is a 206 with exactly those bytes") {
    auto answer = ask(thousandBytes(), {{"Range", "bytes=26-28"}});
    CHECK(answer.status == 206);
    CHECK(answer.body == "abc");
    CHECK(answer.field("Content-Range") == "bytes 26-28/1000");
    CHECK(answer.field("Content-Type") == "text/plain");
    CHECK_FALSE(answer.field("ETag").empty());
}

TEST_CASE("several ranges are a multipart answer whose parts say where they belong") {
    auto answer = ask(thousandBytes(), {{"Range", "bytes=0-2,520-522"}});
    CHECK(answer.status == 206);
    CHECK(answer.field("Content-Range").empty());
    std::string type = answer.field("Content-Type");
    std::string start = "multipart/byteranges; boundary=";
    REQUIRE(type.substr(0, start.size()) == start);
    std::string boundary = type.substr(start.size());
    CHECK(answer.body == "--" + boundary +
                             "\r\nContent-Type: text/plain\r\nContent-Range: bytes 0-2/1000\r\n\r\nabc" +
                             "\r\n--" + boundary +
                             "\r\nContent-Type: text/plain\r\nContent-Range: bytes 520-522/1000\r\n\r\nabc" +
                             "\r\n--" + boundary + "--\r\n");
}

TEST_CASE("ranges that merge into one are answered as one") {
    auto answer = ask(thousandBytes(), {{"Range", "bytes=0-2,3-5"}});
    CHECK(answer.field("Content-Range") == "bytes 0-5/1000");
    CHECK(answer.body == "abcdef");
}

TEST_CASE("416 says how long the file is, and which version") {
    auto answer = ask(thousandBytes(), {{"Range", "bytes=1000-"}});
    CHECK(answer.status == 416);
    CHECK(answer.field("Content-Range") == "bytes */1000");
    CHECK(answer.field("ETag") == thousandBytes().validators.etag);
    CHECK(answer.field("Content-Type") == "application/problem+json");
}

TEST_CASE("HEAD ignores Range") {
    CHECK(ask(thousandBytes(), {{"Range", "bytes=0-2"}}, "HEAD").status == 200);
    CHECK(ask(thousandBytes(), {{"Range", "bytes=5000-"}}, "HEAD").status == 200);
}

TEST_CASE("another version than If-Range names is sent whole") {
    auto answer = ask(thousandBytes(), {{"Range", "bytes=0-2"}, {"If-Range", "\"old\""}});
    CHECK(answer.status == 200);
    CHECK(answer.body.size() == 1000);
}

TEST_CASE("304 and 412 carry the validators, and come before the range") {
    std::string tag = thousandBytes().validators.etag;
    auto notModified = ask(thousandBytes(), {{"Range", "bytes=5000-"}, {"If-None-Match", tag}});
    CHECK(notModified.status == 304);
    CHECK(notModified.body.empty());
    CHECK(notModified.field("ETag") == tag);
    CHECK(notModified.field("Cache-Control") == "no-cache");
    auto failed = ask(thousandBytes(), {{"Range", "bytes=0-2"}, {"If-Match", "\"old\""}});
    CHECK(failed.status == 412);
    CHECK(failed.field("ETag") == tag);
}

TEST_CASE("the head of a response ends with an empty line and counts the body") {
    HttpResponse response;
    response.set("ETag", "\"x\"");
    response.body.push_back(std::string("12345"));
    auto headOf = [&](std::int64_t now, bool keepsAlive, BodyFraming framing) {
        std::string head;
        appendResponseHead(head, response, now, keepsAlive, framing);
        return head;
    };
    CHECK(headOf(784111777, true, BodyFraming::length) ==
          "HTTP/1.1 200 OK\r\nDate: Sun, 06 Nov 1994 08:49:37 GMT\r\nServer: stipple\r\nETag: \"x\"\r\n"
          "Content-Length: 5\r\nConnection: keep-alive\r\n\r\n");
    CHECK(headOf(784111777, true, BodyFraming::chunked) ==
          "HTTP/1.1 200 OK\r\nDate: Sun, 06 Nov 1994 08:49:37 GMT\r\nServer: stipple\r\nETag: \"x\"\r\n"
          "Transfer-Encoding: chunked\r\nConnection: keep-alive\r\n\r\n");
    CHECK(headOf(784111777, false, BodyFraming::untilClose) ==
          "HTTP/1.1 200 OK\r\nDate: Sun, 06 Nov 1994 08:49:37 GMT\r\nServer: stipple\r\nETag: \"x\"\r\n"
          "Connection: close\r\n\r\n");
    response.status = 304;
    response.body.clear();
    CHECK(headOf(0, false, BodyFraming::length).find("Content-Length") == std::string::npos);
    CHECK(headOf(0, false, BodyFraming::length).find("Connection: close") != std::string::npos);
}
