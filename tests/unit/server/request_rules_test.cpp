#include "server/site/request_rules.hpp"

#include <catch2/catch.hpp>

using namespace stipple::server;

namespace {

// Status of the refusal; 0 if the request may go on.
int refusal(std::vector<std::pair<std::string_view, std::string_view>> fields, int version = 11) {
    auto response = checkRequestRules({"GET", "/", version, std::move(fields)});
    if (response)
        CHECK(response->closes);
    return response ? response->status : 0;
}

} // namespace

TEST_CASE("an ordinary request may go on") {
    CHECK(refusal({{"Host", "localhost:8017"}}) == 0);
    CHECK(refusal({{"Host", "[::1]:8017"}, {"Content-Length", "0"}}) == 0);
    CHECK(refusal({}, 10) == 0);
    CHECK(refusal({{"Host", "a"}, {"Expect", "100-Continue"}}) == 0);
}

TEST_CASE("a request of HTTP/1.1 names one host") {
    CHECK(refusal({}) == 400);
    CHECK(refusal({{"Host", "a"}, {"host", "a"}}) == 400);
    CHECK(refusal({{"Host", "a, b"}}) == 400);
    CHECK(refusal({{"Host", "user@a"}}) == 400);
    CHECK(refusal({{"Host", "a/b"}}) == 400);
}

TEST_CASE("whatever may have a body is refused") {
    CHECK(refusal({{"Host", "a"}, {"Content-Length", "1"}}) == 413);
    CHECK(refusal({{"Host", "a"}, {"Content-Length", "0"}, {"Content-Length", "0"}}) == 400);
    CHECK(refusal({{"Host", "a"}, {"Content-Length", "+0"}}) == 413);
    CHECK(refusal({{"Host", "a"}, {"Content-Length", ""}}) == 413);
    CHECK(refusal({{"Host", "a"}, {"Transfer-Encoding", "chunked"}}) == 413);
    CHECK(refusal({{"Host", "a"}, {"Transfer-Encoding", "identity"}}) == 501);
    CHECK(refusal({{"Host", "a"}, {"Transfer-Encoding", "gzip, chunked"}}) == 501);
    CHECK(refusal({{"Host", "a"}, {"Transfer-Encoding", "chunked"}, {"Transfer-Encoding", "x"}}) == 501);
    CHECK(refusal({{"Transfer-Encoding", "chunked"}}, 10) == 501);
}

TEST_CASE("unknown expectations and versions are refused") {
    CHECK(refusal({{"Host", "a"}, {"Expect", "tea"}}) == 417);
    CHECK(refusal({{"Host", "a"}}, 20) == 505);
    CHECK(refusal({{"Host", "a"}}, 12) == 505);
}
