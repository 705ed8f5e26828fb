// What a connection does: many requests, bad requests, slow clients, many clients, the end.
#include "tests/http/support/raw_client.hpp"
#include "tests/http/support/test_server.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>

using namespace stipple;
using namespace stipple::test;

namespace {

const std::string smallRange = "GET /clouds/town.stipple HTTP/1.1\r\nHost: a\r\nRange: bytes=0-9\r\n\r\n";

double secondsOf(const std::function<void()>& work) {
    auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

} // namespace

TEST_CASE("a connection is kept for further requests until one asks to close") {
    TestServer server;
    RawClient client(server.port());
    for (int i = 0; i < 20; ++i)
        REQUIRE(client.ask("GET /clouds/town.stipple HTTP/1.1\nHost: a\nRange: bytes=0-9").status == 206);
    auto last = client.ask("GET / HTTP/1.1\nHost: a\nConnection: foo, Close");
    CHECK(last.field("connection") == "close");
    CHECK(client.isClosedWithin(2000));
    CHECK(server.logOf(21).size() == 21);
}

TEST_CASE("an HTTP/1.0 client is answered and its connection closed") {
    TestServer server;
    RawClient client(server.port());
    CHECK(client.ask("GET / HTTP/1.0").status == 200);
    CHECK(client.isClosedWithin(2000));
}

TEST_CASE("pipelined requests are answered in order") {
    TestServer server;
    RawClient client(server.port());
    std::string requests;
    for (int i = 0; i < 50; ++i)
        requests += "GET /pattern.bin HTTP/1.1\r\nHost: a\r\nRange: bytes=" + std::to_string(i * 1000) + "-" +
                    std::to_string(i * 1000 + 99'999) + "\r\n\r\n";
    std::thread sender([&] { client.send(requests); });
    int wrong = 0;
    for (int i = 0; i < 50; ++i) {
        auto response = client.receive();
        wrong += response.status != 206 || response.body.size() != 100'000 ||
                 response.body[0] != patternByte(static_cast<std::uint64_t>(i) * 1000);
    }
    sender.join();
    CHECK(wrong == 0);
}

TEST_CASE("requests that another reader might split differently are refused and the connection closed") {
    TestServer server;
    const std::string get = "GET / HTTP/1.1\r\nHost: a\r\n",
                      smuggled = "GET /smuggled HTTP/1.1\r\nHost: a\r\n\r\n";
    struct Case {
        const char* name;
        std::string bytes;
    };
    for (const Case& shape : {
             Case{"a body of known length",
                  get + "Content-Length: " + std::to_string(smuggled.size()) + "\r\n\r\n"},
             {"chunked", get + "Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n"},
             {"chunked and a length", get + "Transfer-Encoding: chunked\r\nContent-Length: 4\r\n\r\n"},
             {"a length and chunked", get + "Content-Length: 4\r\nTransfer-Encoding: chunked\r\n\r\n"},
             {"an unknown coding", get + "Transfer-Encoding: xchunked\r\n\r\n"},
             {"a coding that is named twice", get + "Transfer-Encoding: identity, chunked\r\n\r\n"},
             {"a coding with a space before the colon", get + "Transfer-Encoding : chunked\r\n\r\n"},
             {"a coding behind a vertical tab", get + "Transfer-Encoding:\x0b"
                                                      "chunked\r\n\r\n"},
             {"two lengths", get + "Content-Length: 0\r\nContent-Length: 5\r\n\r\n"},
             {"a list of lengths", get + "Content-Length: 0, 5\r\n\r\n"},
             {"a signed length", get + "Content-Length: +0\r\n\r\n"},
             {"a negative length", get + "Content-Length: -1\r\n\r\n"},
             {"a length beyond 2^64", get + "Content-Length: 18446744073709551616\r\n\r\n"},
             {"HTTP/1.0 with a coding", "GET / HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n"},
             {"no host", "GET / HTTP/1.1\r\n\r\n"},
             {"two hosts", get + "Host: b\r\n\r\n"},
             {"a field without a name", get + ": x\r\n\r\n"},
             {"a field without a colon", get + "nonsense\r\n\r\n"},
             {"a NUL in a field", get + std::string("X: a\0b\r\n\r\n", 10)},
             {"a bare carriage return in a field", get + "X: a\rY: b\r\n\r\n"},
             {"a space before the first field", "GET / HTTP/1.1\r\n Host: a\r\n\r\n"},
             {"a folded field", get + "X: a\r\n b\r\n\r\n"},
             {"a folded coding", get + "X: a\r\n\tTransfer-Encoding: chunked\r\n\r\n"},
             {"bare line feeds", "GET / HTTP/1.1\nHost: a\n\n"},
             {"a bare line feed between fields", get + "X: a\nTransfer-Encoding: chunked\r\n\r\n"},
             {"an end of bare line feeds", "GET / HTTP/1.1\r\nHost: a\n\n"},
             {"a length with a space before the colon", get + "Content-Length : 5\r\n\r\n"},
             {"a length in hexadecimal", get + "Content-Length: 0x5\r\n\r\n"},
             {"a length and an empty coding", get + "Content-Length: 5\r\nTransfer-Encoding:\r\n\r\n"},
             {"two equal lengths", get + "Content-Length: 5\r\nContent-Length: 5\r\n\r\n"},
             {"a coding in capitals", get + "TRANSFER-ENCODING: CHUNKED\r\n\r\n"},
             {"a quoted coding", get + "Transfer-Encoding: \"chunked\"\r\n\r\n"},
             {"a coding with a parameter", get + "Transfer-Encoding: chunked;x=y\r\n\r\n"},
             {"a coding of two lines", get + "Transfer-Encoding: gzip\r\nTransfer-Encoding: chunked\r\n\r\n"},
             {"an oversized chunk", get + "Transfer-Encoding: chunked\r\n\r\nFFFFFFFFFFFFFFFF\r\n"},
             {"HTTP/1.0 with a length", "POST / HTTP/1.0\r\nContent-Length: 5\r\n\r\n"},
             {"a space in the target", "GET /a b HTTP/1.1\r\nHost: a\r\n\r\n"},
             {"a second version", "GET / HTTP/1.1 HTTP/1.1\r\nHost: a\r\n\r\n"},
             {"a host with a path", "GET / HTTP/1.1\r\nHost: a/b\r\n\r\n"},
             {"an empty first line of spaces", " \r\n" + get + "\r\n"},
             {"no version", "GET /\r\n\r\n"},
             {"HTTP/2", "GET / HTTP/2.0\r\nHost: a\r\n\r\n"},
             {"the HTTP/2 preface", "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"},
             {"two spaces", "GET  / HTTP/1.1\r\nHost: a\r\n\r\n"},
             {"TLS", std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n", 15)},
         }) {
        INFO(shape.name);
        std::size_t before = server.log().size();
        RawClient client(server.port());
        client.send(shape.bytes + smuggled);
        auto response = client.receive();
        CHECK(response.status >= 400);
        CHECK(response.field("connection") == "close");
        CHECK(client.isClosedWithin(3000));
        auto log = server.logOf(before + 1);
        REQUIRE(log.size() == before + 1); // what came behind was not taken for a request
        CHECK(log.back().target != "/smuggled");
    }
}

TEST_CASE("headers and targets beyond the limits are refused with their own statuses") {
    TestServer server;
    CHECK(askOnce(server.port(), "GET /" + std::string(9000, 'a') + " HTTP/1.1\nHost: a").status == 414);
    CHECK(askOnce(server.port(), "GET /" + std::string(50'000, 'a') + " HTTP/1.1\nHost: a").status == 414);
    CHECK(askOnce(server.port(), "GET / HTTP/1.1\nHost: a\nX: " + std::string(20'000, 'a')).status == 431);
    std::string many = "GET / HTTP/1.1\nHost: a";
    for (int i = 0; i < 3000; ++i)
        many += "\nX" + std::to_string(i) + ": 1";
    CHECK(askOnce(server.port(), many).status == 431);
}

TEST_CASE("every cut of a request leaves the server well") {
    TestServer server;
    for (std::size_t length = 0; length < smallRange.size(); ++length) {
        RawClient client(server.port());
        client.send(smallRange.substr(0, length));
        client.finishSending();
        REQUIRE(client.receive().status == 0);
    }
    CHECK(askOnce(server.port(), "GET / HTTP/1.1\nHost: a").status == 200);
}

TEST_CASE("a client that dribbles its header is cut, whatever it still sends") {
    auto limits = TestServer::quickLimits();
    limits.header = std::chrono::milliseconds(300);
    TestServer server(limits);
    RawClient client(server.port());
    bool isCut = false;
    double seconds = secondsOf([&] {
        for (std::size_t i = 0; i < 200 && !isCut; ++i) {
            client.send(smallRange.substr(i % 30, 1));
            isCut = client.isClosedWithin(30);
        }
    });
    CHECK(isCut);
    CHECK(seconds >= 0.25);
    CHECK(seconds < 3);
}

TEST_CASE("an idle connection is closed after its time, and not before") {
    auto limits = TestServer::quickLimits();
    limits.idle = std::chrono::milliseconds(400);
    TestServer server(limits);
    RawClient client(server.port());
    CHECK(client.ask("GET / HTTP/1.1\nHost: a").status == 200);
    CHECK_FALSE(client.isClosedWithin(200));
    CHECK(client.isClosedWithin(3000));
}

TEST_CASE("a client that stops reading is cut, and the log says that its answer was") {
    auto limits = TestServer::quickLimits();
    limits.noProgress = std::chrono::milliseconds(300);
    TestServer server(limits);
    RawClient client(server.port());
    client.setReceiveBuffer(4096);
    client.send("GET /huge.bin HTTP/1.1\r\nHost: a\r\n\r\n");
    auto log = server.logOf(1);
    REQUIRE(log.size() == 1);
    CHECK_FALSE(log[0].isComplete);
    CHECK(log[0].bodyBytes < 100'000'000);
}

TEST_CASE("two hundred clients at once are all answered") {
    TestServer server;
    std::vector<std::unique_ptr<RawClient>> clients;
    for (int i = 0; i < 200; ++i)
        clients.push_back(std::make_unique<RawClient>(server.port()));
    int wrong = 0;
    for (int round = 0; round < 3; ++round) {
        for (auto& client : clients)
            client->send(smallRange);
        for (auto& client : clients)
            wrong += client->receive().status != 206;
    }
    CHECK(wrong == 0);
    CHECK(server.logOf(600).size() == 600);
}

TEST_CASE("clients that come at once are let in at once, however busy the loop is") {
    struct Order {
        std::atomic<int> busy{0}, first{-1}, last{-1};
    };
    class Handler final : public server::RequestHandler {
      public:
        explicit Handler(Order& order) : order_(order) {}
        server::Answer answer(const server::HttpRequest& request, std::int64_t) const override {
            if (request.target == "/busy") {
                std::this_thread::sleep_for(std::chrono::microseconds(500));
                ++order_.busy;
            } else {
                if (order_.first < 0)
                    order_.first = order_.busy.load();
                order_.last = order_.busy.load();
            }
            return server::HttpResponse();
        }
        void complete(const server::HttpRequest&, server::HttpResponse&) const override {}

      private:
        Order& order_;
    };
    constexpr int busyRequests = 1000, crowdSize = 60;
    Order order;
    server::ServerOptions options;
    options.threads = 1;
    auto started = server::Server::start(options, std::make_shared<Handler>(order), {});
    REQUIRE(started.ok());
    RawClient busy((*started)->port());
    std::string requests;
    for (int i = 0; i < busyRequests; ++i)
        requests += "GET /busy HTTP/1.1\r\nHost: a\r\n\r\n";
    REQUIRE(busy.send(requests));
    std::vector<std::unique_ptr<RawClient>> crowd;
    for (int i = 0; i < crowdSize; ++i) {
        crowd.push_back(std::make_unique<RawClient>((*started)->port()));
        REQUIRE(crowd.back()->send("GET / HTTP/1.1\r\nHost: a\r\n\r\n"));
    }
    for (auto& client : crowd)
        CHECK(client->receive().status == 200);
    CHECK(order.busy < busyRequests); // it was busy all the while
    // One let in for each round of 16 answers would be 59 rounds.
    CHECK(order.last - order.first < 20 * 16);
}

TEST_CASE("clients beyond the limit wait their turn") {
    auto limits = TestServer::quickLimits();
    limits.connections = 2;
    TestServer server(limits);
    auto first = std::make_unique<RawClient>(server.port()),
         second = std::make_unique<RawClient>(server.port());
    CHECK(first->ask("GET / HTTP/1.1\nHost: a").status == 200);
    CHECK(second->ask("GET / HTTP/1.1\nHost: a").status == 200);
    RawClient third(server.port());
    third.send(smallRange);
    CHECK_FALSE(third.isClosedWithin(200));
    CHECK(server.log().size() == 2);
    first.reset();
    CHECK(third.receive().status == 206);
}

TEST_CASE("idle connections make room for clients that wait") {
    auto limits = TestServer::quickLimits();
    limits.connections = 2;
    TestServer server(limits);
    RawClient first(server.port()), second(server.port());
    CHECK(first.ask("GET / HTTP/1.1\nHost: a").status == 200);
    CHECK(second.ask("GET / HTTP/1.1\nHost: a").status == 200);
    RawClient third(server.port());
    third.send(smallRange);
    CHECK(third.receive().status == 206);
}

TEST_CASE("one client has no more connections than its share, and others have theirs") {
    auto limits = TestServer::quickLimits();
    limits.connectionsPerClient = 2;
    TestServer server(limits);
    auto first = std::make_unique<RawClient>(server.port());
    RawClient second(server.port());
    CHECK(first->ask("GET / HTTP/1.1\nHost: a").status == 200);
    CHECK(second.ask("GET / HTTP/1.1\nHost: a").status == 200);
    RawClient third(server.port());
    CHECK(third.isClosedWithin(2000));
    RawClient other(server.port(), "127.0.0.2");
    CHECK(other.ask("GET / HTTP/1.1\nHost: a").status == 200);
    CHECK(server.server().openConnections() == 3);
    first.reset();
    int status = 0;
    for (int i = 0; i < 100 && status != 200; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        status = askOnce(server.port(), "GET / HTTP/1.1\nHost: a").status;
    }
    CHECK(status == 200);
}

TEST_CASE("an announced end closes each connection after its answer, and still lets clients in") {
    TestServer server;
    RawClient before(server.port());
    CHECK(before.ask("GET / HTTP/1.1\nHost: a").field("connection") == "keep-alive");
    server.server().announceEnd();
    CHECK_FALSE(before.isClosedWithin(100));
    CHECK(before.ask("GET / HTTP/1.1\nHost: a").field("connection") == "close");
    CHECK(before.isClosedWithin(2000));
    CHECK(askOnce(server.port(), "GET / HTTP/1.1\nHost: a").status == 200);
}

TEST_CASE("stopping closes idle connections, finishes running answers and accepts nothing more") {
    TestServer server;
    RawClient idle(server.port()), busy(server.port());
    CHECK(idle.ask("GET / HTTP/1.1\nHost: a").status == 200);
    busy.setReceiveBuffer(65536);
    busy.send("GET /huge.bin HTTP/1.1\r\nHost: a\r\nRange: bytes=0-99999999\r\n\r\n");
    while (server.server().openConnections() < 2)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(100)); // the answer is under way
    server.server().stop();
    CHECK(idle.isClosedWithin(2000));
    CHECK_FALSE(server.server().waitUntilDrained(std::chrono::milliseconds(100)));
    auto response = busy.receive();
    CHECK(response.isComplete);
    CHECK(response.body.size() == 100'000'000);
    CHECK(server.server().waitUntilDrained(std::chrono::milliseconds(5000)));
    CHECK_FALSE(RawClient(server.port()).isConnected());
}

TEST_CASE("cutting ends what stopping still waits for") {
    TestServer server;
    RawClient busy(server.port());
    busy.setReceiveBuffer(4096);
    busy.send("GET /huge.bin HTTP/1.1\r\nHost: a\r\n\r\n");
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    server.server().stop();
    CHECK_FALSE(server.server().waitUntilDrained(std::chrono::milliseconds(100)));
    server.server().cut();
    CHECK(server.server().waitUntilDrained(std::chrono::milliseconds(5000)));
    auto log = server.logOf(1); // reading what is left in so small a window would take minutes
    REQUIRE(log.size() == 1);
    CHECK_FALSE(log[0].isComplete);
}
