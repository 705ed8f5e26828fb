// Files that are replaced, written to or cut while they are served: never bytes of two versions in one
// answer.
#include "tests/http/support/raw_client.hpp"
#include "tests/http/support/test_server.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <thread>

using namespace stipple;
using namespace stipple::test;
namespace fs = std::filesystem;

namespace {

const std::string cloudTarget = "/clouds/town.stipple";

RawResponse ask(TestServer& server, const std::string& line, const std::string& fields = "") {
    return askOnce(server.port(), line + " HTTP/1.1\nHost: a" + (fields.empty() ? "" : "\n" + fields));
}

void replaceCloud(TestServer& server, std::size_t points) {
    std::string fresh = server.folder().cloud().string() + ".new";
    writeCloud(fresh, points, 2);
    fs::rename(fresh, server.folder().cloud());
}

} // namespace

TEST_CASE("a replaced cloud has a new tag, and requests for the old one get 412 or the new one whole") {
    TestServer server;
    std::string old = ask(server, "HEAD " + cloudTarget).field("etag");
    replaceCloud(server, 30'000);
    auto fresh = ask(server, "GET " + cloudTarget);
    CHECK(fresh.status == 200);
    CHECK(fresh.field("etag") != old);
    CHECK(fresh.body == readFile(server.folder().cloud()));
    CHECK(ask(server, "GET " + cloudTarget, "If-Match: " + old + "\nRange: bytes=0-9").status == 412);
    CHECK(ask(server, "GET " + cloudTarget, "If-Range: " + old + "\nRange: bytes=0-9").status == 200);
    CHECK(ask(server, "GET " + cloudTarget, "If-None-Match: " + old).status == 200);
    CHECK(ask(server, "GET /api/v1/clouds").body.find("30000") != std::string::npos);
}

TEST_CASE("a download that runs keeps the file that it began with") {
    TestServer server;
    RawClient client(server.port());
    client.setReceiveBuffer(65536);
    client.send("GET /huge.bin HTTP/1.1\r\nHost: a\r\nRange: bytes=2100000000-2200000000\r\n\r\n");
    server.logOf(0);
    while (server.server().openConnections() < 1)
        std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    std::ofstream(server.folder().page() / "other.bin") << "short";
    fs::rename(server.folder().page() / "other.bin", server.folder().page() / "huge.bin");
    auto response = client.receive();
    CHECK(response.isComplete);
    CHECK(response.body.size() == 100'000'001);
    CHECK(response.body.substr((std::uint64_t{1} << 31) - 2 - 2100000000, 4) == TestFolder::mark);
    CHECK(ask(server, "GET /huge.bin").body == "short");
}

TEST_CASE("a file that is cut under a download ends it short, with no padding") {
    TestServer server;
    RawClient client(server.port());
    client.setReceiveBuffer(65536);
    client.send("GET /huge.bin HTTP/1.1\r\nHost: a\r\n\r\n");
    while (server.server().openConnections() < 1)
        std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    fs::resize_file(server.folder().page() / "huge.bin", 1000);
    auto response = client.receive();
    CHECK(response.status == 200);
    CHECK_FALSE(response.isComplete);
    auto log = server.logOf(1);
    REQUIRE(log.size() == 1);
    CHECK_FALSE(log[0].isComplete);
}

TEST_CASE("what has left already of a file that is then cut or overwritten is the old file's bytes") {
    for (bool isCut : {true, false}) {
        TestServer server;
        RawClient client(server.port());
        client.setReceiveBuffer(65536);
        client.send("GET /pattern.bin HTTP/1.1\r\nHost: a\r\n\r\n");
        while (server.server().openConnections() < 1)
            std::this_thread::yield();
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        fs::path file = server.folder().page() / "pattern.bin";
        if (isCut)
            fs::resize_file(file, 100'001);
        else
            std::fstream(file, std::ios::in | std::ios::out).write(std::string(300'000, 'x').data(), 300'000);
        auto response = client.receive();
        REQUIRE(response.body.size() > 100'001);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < response.body.size(); ++i)
            wrong += response.body[i] != patternByte(i);
        CHECK(wrong == 0);
    }
}

TEST_CASE("a file that is written to under a download ends it short") {
    TestServer server;
    RawClient client(server.port());
    client.setReceiveBuffer(65536);
    client.send("GET /huge.bin HTTP/1.1\r\nHost: a\r\n\r\n");
    while (server.server().openConnections() < 1)
        std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    std::fstream(server.folder().page() / "huge.bin", std::ios::in | std::ios::out).write("new", 3);
    CHECK_FALSE(client.receive().isComplete);
}

TEST_CASE("a cloud that is cut, damaged or removed is refused until it is whole again") {
    TestServer server;
    std::string whole = readFile(server.folder().cloud());
    fs::resize_file(server.folder().cloud(), whole.size() - 1);
    auto response = ask(server, "GET " + cloudTarget);
    CHECK(response.status == 503);
    CHECK(response.field("content-type") == "application/problem+json");
    CHECK(response.body.find(server.folder().path().string()) ==
          std::string::npos); // no path of this machine
    CHECK(ask(server, "GET /api/v1/clouds").body == "{\"clouds\":[]}\n");
    std::ofstream(server.folder().cloud(), std::ios::binary) << "nonsense";
    CHECK(ask(server, "GET " + cloudTarget).status == 503);
    fs::remove(server.folder().cloud());
    CHECK(ask(server, "GET " + cloudTarget).status == 404);
    std::ofstream(server.folder().cloud(), std::ios::binary) << whole;
    CHECK(ask(server, "GET " + cloudTarget).body == whole);
}
