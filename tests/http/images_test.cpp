// Pictures by address over a socket: how often a client may have one drawn.
#include "shared/base/text.hpp"
#include "tests/http/support/raw_client.hpp"
#include "tests/http/support/test_server.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::test;

namespace {

std::string get(int width, const char* more = "") {
    return cat("GET /api/v1/clouds/town/image?width=", width, "&height=8", more,
               " HTTP/1.1\nHost: localhost\n");
}

TestServer::Prepare drawing(double perMinute) {
    return [perMinute](TestFolder&) {
        server::SiteOptions options;
        options.api.picturesPerMinute = perMinute;
        return options;
    };
}

} // namespace

TEST_CASE("a client that wants pictures drawn too often is told when to come again") {
    TestServer server(TestServer::quickLimits(), drawing(3));
    for (int width : {8, 9, 10})
        CHECK(askOnce(server.port(), get(width)).status == 200);
    RawResponse refused = askOnce(server.port(), get(11));
    CHECK(refused.status == 429);
    CHECK(refused.field("retry-after") == "20");
    CHECK(refused.field("content-type") == "application/problem+json");
    CHECK(refused.field("cache-control") == "no-store");
    CHECK(refused.body.find("/api/v1/problems/too-many-requests") != std::string::npos);
    // What is kept, or what the client has, is not drawn; nor are other answers pictures.
    RawResponse kept = askOnce(server.port(), get(9));
    CHECK(kept.status == 200);
    CHECK(askOnce(server.port(), get(9) + "If-None-Match: " + kept.field("etag") + "\n").status == 304);
    CHECK(askOnce(server.port(), get(0)).status == 400);
    CHECK(askOnce(server.port(), "GET /api/v1/clouds/town/statistics?bins=2 HTTP/1.1\nHost: localhost\n")
              .status == 200);
    // Another client has turns of its own.
    CHECK(RawClient(server.port(), "127.0.0.2").ask(get(12)).status == 200);
}

TEST_CASE("pictures are drawn without a limit where none is wanted") {
    TestServer server(TestServer::quickLimits(), drawing(0));
    RawClient client(server.port());
    for (int width = 8; width < 80; ++width)
        CHECK(client.ask(get(width, width % 2 == 0 ? "&format=webp" : "")).status == 200);
}
