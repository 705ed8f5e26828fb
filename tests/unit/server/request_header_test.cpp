#include "server/http/request_header.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace stipple::server;

namespace {

using State = HeaderScan::State;

State stateOf(std::string_view bytes) {
    return HeaderScan().scan(bytes);
}

int statusOf(const std::string& header) {
    HttpRequest request;
    return parseRequestHeader(header, request);
}

const std::string simple = "GET /a?b HTTP/1.1\r\nHost: x\r\nRange:  bytes=0-1 \r\nEmpty:\r\n\r\n";

} // namespace

TEST_CASE("a header ends at its empty line, whatever follows and however it arrives") {
    std::string bytes = simple + "GET / HTTP/1.1\r\n";
    HeaderScan scan;
    for (std::size_t size = 0; size < simple.size(); ++size) {
        INFO(size);
        REQUIRE(scan.scan(std::string_view(bytes).substr(0, size)) == State::needsMore);
    }
    REQUIRE(scan.scan(bytes) == State::complete);
    CHECK(scan.header(bytes) == simple);
    CHECK(scan.endBytes() == simple.size());
}

TEST_CASE("empty lines before a request are no part of it") {
    HeaderScan scan;
    std::string bytes = "\r\n\r\n" + simple;
    CHECK(scan.scan("\r") == State::needsMore);
    CHECK(scan.scan("\r\n") == State::needsMore);
    REQUIRE(scan.scan(bytes) == State::complete);
    CHECK(scan.header(bytes) == simple);
    CHECK(scan.endBytes() == bytes.size());
}

TEST_CASE("lines that others might split differently are refused as soon as they are seen") {
    CHECK(stateOf("GET / HTTP/1.1\nHost: x\n\n") == State::malformed);
    CHECK(stateOf("GET / HTTP/1.1\r\nHost: x\n") == State::malformed);
    CHECK(stateOf("GET / HTTP/1.1\r\nHost: x\r\n\n") == State::malformed);
    CHECK(stateOf("\nGET / HTTP/1.1\r\n") == State::malformed);
    CHECK(stateOf("GET / HTTP/1.1\r\n Host: x\r\n") == State::malformed);
    CHECK(stateOf("GET / HTTP/1.1\r\nHost: x\r\n\tfolded\r\n") == State::malformed);
    CHECK(stateOf("GET / HTTP/1.1\r\nHost: x\r\n \r\n\r\n") == State::malformed);
    CHECK(stateOf("\x16\x03\x01") == State::malformed);
    CHECK(stateOf(" GET / HTTP/1.1") == State::malformed);
    CHECK(stateOf("\r\n\x16") == State::malformed);
    CHECK(stateOf("GET / HTTP/1.1\r\nHost: x\r\n") == State::needsMore);
}

TEST_CASE("a header is parsed without being copied, and its list of fields can be used again") {
    HttpRequest request;
    REQUIRE(parseRequestHeader(simple, request) == 0);
    CHECK(request.method == "GET");
    CHECK(request.target == "/a?b");
    CHECK(request.version == 11);
    REQUIRE(request.fields.size() == 3);
    CHECK(request.fields[1].first == "Range");
    CHECK(request.fields[1].second == "bytes=0-1");
    CHECK(request.fields[2].second.empty());
    for (auto view : {request.target, request.fields[0].first, request.fields[1].second})
        CHECK((view.data() >= simple.data() && view.data() < simple.data() + simple.size()));
    const std::string other = "HEAD / HTTP/1.0\r\n\r\n";
    REQUIRE(parseRequestHeader(other, request) == 0);
    CHECK(request.fields.empty());
    CHECK(request.version == 10);
}

TEST_CASE("what is no request has a status") {
    CHECK(statusOf("GET / HTTP/2.0\r\n\r\n") == 505);
    CHECK(statusOf("GET / HTTP/1.2\r\n\r\n") == 505);
    CHECK(statusOf("GET / http/1.1\r\n\r\n") == 400);
    CHECK(statusOf("GET /\r\n\r\n") == 400);
    CHECK(statusOf("GET  / HTTP/1.1\r\n\r\n") == 400);
    CHECK(statusOf("GET / HTTP/1.1 \r\n\r\n") == 400);
    CHECK(statusOf("GET /a b HTTP/1.1\r\n\r\n") == 400);
    CHECK(statusOf("G\x01T / HTTP/1.1\r\n\r\n") == 400);
    CHECK(statusOf("GET / HTTP/1.1\r\nA : b\r\n\r\n") == 400);
    CHECK(statusOf("GET / HTTP/1.1\r\nA\r\n\r\n") == 400);
    CHECK(statusOf("GET / HTTP/1.1\r\n: b\r\n\r\n") == 400);
    CHECK(statusOf("GET / HTTP/1.1\r\nA: b\rc\r\n\r\n") == 400);
    CHECK(statusOf(std::string("GET / HTTP/1.1\r\nA: b\0c\r\n\r\n", 27)) == 400);
    CHECK(statusOf("GET / HTTP/1.1\r\nA: b\x0b\r\n\r\n") == 400);
    CHECK(statusOf("GET / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n") == 400);
    CHECK(statusOf("GET / HTTP/1.1\r\nContent-Length: x\r\n\r\n") == 400);
}

TEST_CASE("a connection goes on unless one side says otherwise") {
    auto keepsAlive = [](int version, std::initializer_list<std::string_view> options) {
        HttpRequest request;
        request.version = version;
        for (std::string_view option : options)
            request.fields.emplace_back("connection", option);
        return wantsKeepAlive(request);
    };
    CHECK(keepsAlive(11, {}));
    CHECK(keepsAlive(11, {"keep-alive", "Upgrade, foo"}));
    CHECK(keepsAlive(11, {"closed"}));
    CHECK_FALSE(keepsAlive(11, {"Close"}));
    CHECK_FALSE(keepsAlive(11, {"foo", "bar ,\tclose , x"}));
    CHECK_FALSE(keepsAlive(10, {"keep-alive"}));
}
