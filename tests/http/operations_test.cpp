// What whoever runs the server asks it: is it well, and what has it done.
#include "tests/http/support/program.hpp"
#include "tests/http/support/raw_client.hpp"
#include "tests/http/support/test_server.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <functional>
#include <sstream>
#include <thread>

using namespace stipple;
using namespace stipple::test;

namespace {

RawResponse ask(std::uint16_t port, const std::string& target, const std::string& fields = "") {
    return askOnce(port, "GET " + target + " HTTP/1.1\nHost: a" + fields);
}

// The value of "name{labels}" in Prometheus' text; -1: it is not there.
double valueOf(const std::string& text, const std::string& series) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with(series + " "))
            return std::stod(line.substr(series.size() + 1));
    return -1;
}

Program serveWith(const TestFolder& folder, std::vector<std::string> more) {
    std::vector<std::string> arguments{"serve",  folder.cloud().string(), "--port", "0", "--json",
                                       "--page", folder.page().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Program(arguments, folder.path() / "errors.txt");
}

} // namespace

TEST_CASE("a server says that it is well until its end is announced") {
    TestServer server;
    for (const char* target : {"/healthz", "/readyz"}) {
        auto response = ask(server.port(), target);
        CHECK(response.status == 200);
        CHECK(response.body == "{\"status\":\"ok\"}\n");
        CHECK(response.field("cache-control") == "no-store");
        CHECK(response.field("x-content-type-options") == "nosniff");
    }
    CHECK(askOnce(server.port(), "HEAD /healthz HTTP/1.1\nHost: a").status == 200);
    CHECK(askOnce(server.port(), "POST /healthz HTTP/1.1\nHost: a\nContent-Length: 0").status == 405);
    server.server().announceEnd();
    for (const char* target : {"/healthz", "/readyz"}) {
        auto response = ask(server.port(), target);
        CHECK(response.status == 503);
        CHECK(response.field("content-type") == "application/problem+json");
    }
    CHECK(ask(server.port(), "/clouds/town.stipple").status == 200);
}

TEST_CASE("a server whose connections are at their limit is well, but not ready") {
    auto limits = TestServer::quickLimits();
    limits.connections = 1;
    TestServer server(limits);
    CHECK(ask(server.port(), "/readyz").status == 503);
    CHECK(ask(server.port(), "/healthz").status == 200);
}

TEST_CASE("a signal announces the end before connections are refused") {
    TestFolder folder;
    Program program = serveWith(folder, {"--notice", "3"});
    std::uint16_t port = portOf(program.line());
    CHECK(ask(port, "/healthz").status == 200);
    program.signal(SIGTERM);
    int status = 200;
    for (int i = 0; i < 100 && status == 200; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        status = ask(port, "/healthz").status;
    }
    CHECK(status == 503);
    auto begin = std::chrono::steady_clock::now();
    program.signal(SIGTERM); // does not wait for the rest of the notice
    CHECK(program.wait() == 0);
    CHECK(std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(2500));
}

TEST_CASE("metrics are nobody's unless they are asked for, and then this machine's or everybody's") {
    TestFolder folder;
    TestServer off;
    CHECK(ask(off.port(), "/metrics").status == 404);

    Program local = serveWith(folder, {"--metrics", "local"});
    std::uint16_t port = portOf(local.line());
    CHECK(ask(port, "/metrics").status == 200);
    for (const char* field : {"X-Forwarded-For: 192.0.2.7", "Forwarded: for=192.0.2.7", "Via: 1.1 proxy"})
        CHECK(ask(port, "/metrics", std::string("\n") + field).status == 404);

    Program all = serveWith(folder, {"--metrics", "all"});
    CHECK(ask(portOf(all.line()), "/metrics", "\nX-Forwarded-For: 192.0.2.7").status == 200);
    CHECK(serveWith(folder, {"--metrics", "some"}).wait() == 2);
}

TEST_CASE("metrics count what was answered") {
    TestFolder folder;
    Program program = serveWith(folder, {"--metrics", "local"});
    std::uint16_t port = portOf(program.line());
    for (int i = 0; i < 3; ++i)
        CHECK(ask(port, "/clouds/town.stipple", "\nRange: bytes=0-99").status == 206);
    CHECK(ask(port, "/clouds/none.stipple").status == 404);
    CHECK(ask(port, "/api/v1/clouds/town").status == 200);
    CHECK(ask(port, "/").status == 200);
    RawClient nonsense(port);
    nonsense.send("nonsense\n\n");
    CHECK(nonsense.receive().status == 400);

    auto response = ask(port, "/metrics");
    CHECK(response.field("content-type") == "text/plain; version=0.0.4; charset=utf-8");
    const std::string& text = response.body;
    CHECK(valueOf(text, "stipple_http_requests_total{route=\"cloud-file\",status=\"2xx\"}") == 3);
    CHECK(valueOf(text, "stipple_http_requests_total{route=\"cloud-file\",status=\"4xx\"}") == 1);
    CHECK(valueOf(text, "stipple_http_requests_total{route=\"api\",status=\"2xx\"}") == 1);
    CHECK(valueOf(text, "stipple_http_requests_total{route=\"page\",status=\"2xx\"}") == 1);
    CHECK(valueOf(text, "stipple_http_requests_total{route=\"invalid\",status=\"4xx\"}") == 1);
    CHECK(valueOf(text, "stipple_http_request_duration_seconds_count{route=\"cloud-file\"}") == 4);
    CHECK(valueOf(text, "stipple_http_request_duration_seconds_bucket{route=\"cloud-file\",le=\"+Inf\"}") ==
          4);
    CHECK(valueOf(text, "stipple_cloud_requests_total{cloud=\"town\"}") == 4);
    CHECK(valueOf(text, "stipple_cloud_response_body_bytes_total{cloud=\"town\"}") >= 300);
    CHECK(text.find("cloud=\"none\"") == std::string::npos); // a client can't make up series
    CHECK(valueOf(text, "stipple_http_requests_in_flight") == 1);
    CHECK(valueOf(text, "stipple_jobs_running") == 0);
    CHECK(valueOf(text, "process_open_fds") > 5);
    CHECK(valueOf(text, "stipple_clouds") == 1);
}

TEST_CASE("what is no request does not count, nor is it logged, as the request before it") {
    TestServer server;
    RawClient client(server.port());
    CHECK(client.ask("GET /pattern.bin HTTP/1.1\nHost: a\nRange: bytes=0-9").status == 206);
    client.send("\x16nonsense");
    CHECK(client.receive().status == 400);
    auto log = server.logOf(2);
    REQUIRE(log.size() == 2);
    CHECK(log[1].target.empty());
    CHECK(log[1].range.empty());
}
