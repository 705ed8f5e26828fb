// Points by address over a socket: sent as they are made, and ended with the client.
#include "shared/base/text.hpp"
#include "tests/http/support/raw_client.hpp"
#include "tests/http/support/test_server.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

using namespace stipple;
using namespace stipple::test;

namespace {

using Clock = std::chrono::steady_clock;

std::string get(const std::string& target, const char* method = "GET") {
    return cat(method, " /api/v1/clouds/", target, " HTTP/1.1\nHost: localhost\n");
}

// Time until no job runs any more.
std::chrono::milliseconds untilIdle(const server::Server& server) {
    auto begin = Clock::now();
    while (server.jobCounts().running > 0 && Clock::now() - begin < std::chrono::seconds(10))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - begin);
}

} // namespace

TEST_CASE("points are sent in chunks while they are made, LAZ at once with its length") {
    TestServer server;
    for (const char* format : {"las", "csv", "ply", "laz"}) {
        INFO(format);
        RawClient client(server.port());
        RawResponse answer = client.ask(get(cat("town/points?limit=500&format=", format)));
        CHECK(answer.status == 200);
        CHECK(answer.isComplete);
        bool isFile = std::string(format) == "laz";
        CHECK((answer.chunks > 0) == !isFile);
        CHECK(answer.field("content-length").empty() == !isFile);
        CHECK(answer.field("content-disposition") == cat("attachment; filename=town-points.", format));
        CHECK(answer.field("access-control-expose-headers").find("Content-Disposition") != std::string::npos);
        if (std::string(format) != "csv")
            CHECK(answer.field("stipple-point-count") == "500");
        // The connection goes on.
        CHECK(client.ask(get("town/nearest?point=0,0,0")).status == 200);
    }
}

TEST_CASE("the head of points says what a GET would say") {
    TestServer server;
    for (const char* format : {"las", "laz"}) {
        RawClient client(server.port());
        client.send(cat("HEAD /api/v1/clouds/town/points?limit=500&format=", format,
                        " HTTP/1.1\r\nHost: localhost\r\n\r\n"));
        RawResponse head = client.receive(false);
        CHECK(head.status == 200);
        CHECK(head.field("stipple-point-count") == "500");
        CHECK(client.ask(get("town")).status == 200);
    }
}

TEST_CASE("a refused parameter is a problem document with the path") {
    TestServer server;
    RawResponse answer = askOnce(server.port(), get("town/points?box=1,2"));
    CHECK(answer.status == 400);
    CHECK(answer.field("content-type") == "application/problem+json");
    CHECK(answer.body.find("\"instance\":\"/api/v1/clouds/town/points\"") != std::string::npos);
    CHECK(answer.body.find("\"parameter\":\"box\"") != std::string::npos);
}

TEST_CASE("a client that leaves ends the work, whatever the format") {
    TestServer server(TestServer::quickLimits(), [](TestFolder& folder) {
        writeCloud((folder.clouds() / "large.stipple").string(), 3'000'000, 7);
        return server::SiteOptions();
    });
    for (const char* what : {"points?format=las", "points?format=csv", "points?format=ply",
                             "points?format=laz", "statistics?bins=1000"}) {
        INFO(what);
        auto client = std::make_unique<RawClient>(server.port());
        client->setReceiveBuffer(4096);
        client->send(cat("GET /api/v1/clouds/large/", what, " HTTP/1.1\r\nHost: localhost\r\n\r\n"));
        auto begin = Clock::now();
        while (server.server().jobCounts().running == 0 && Clock::now() - begin < std::chrono::seconds(10))
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        REQUIRE(server.server().jobCounts().running == 1);
        client.reset();
        auto latency = untilIdle(server.server());
        INFO("ended after " << latency.count() << " ms");
        CHECK(latency < std::chrono::milliseconds(2000)); // 100 on a machine that does nothing else
    }
}
