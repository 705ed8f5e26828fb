// The native HTTP byte source against the real server, and against servers that misbehave.
#include "client/headless/http_source.hpp"

#include "client/headless/http_url.hpp"
#include "client/headless/stored_source.hpp"
#include "tests/http/support/listener.hpp"
#include "tests/http/support/raw_client.hpp"
#include "tests/http/support/test_server.hpp"
#include "tests/support/temporary_folder.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <filesystem>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

using namespace stipple;
using namespace stipple::test;
namespace fs = std::filesystem;

namespace {

std::unique_ptr<ByteSource> open(const std::string& url, HttpSourceOptions options = {}) {
    auto source = openHttpSource(url, options);
    REQUIRE(source.ok());
    return std::move(*source);
}

// Sends fixed bytes to whoever connects, once, after the request came; then closes or keeps silent.
class FixedServer {
  public:
    explicit FixedServer(std::string answer, bool closes = true)
        : answer_(std::move(answer)), closes_(closes) {
        thread_ = std::thread([this] { run(); });
    }
    ~FixedServer() {
        ends_ = true;
        listener_.stop();
        thread_.join();
    }
    std::string url() const { return listener_.origin() + "/x"; }

  private:
    void run() {
        while (!ends_) {
            int client = listener_.accept();
            if (client < 0)
                return;
            char request[4096];
            (void)!::recv(client, request, sizeof request, 0);
            (void)!::send(client, answer_.data(), answer_.size(), MSG_NOSIGNAL);
            while (!closes_ && !ends_)
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            ::close(client);
        }
    }
    std::string answer_;
    bool closes_;
    Listener listener_;
    std::atomic<bool> ends_{false};
    std::thread thread_;
};

ErrorCode errorFrom(const std::string& answer) {
    FixedServer server(answer);
    auto result = readNow(*open(server.url()), {0, 10});
    REQUIRE_FALSE(result.ok());
    return result.error().code;
}

} // namespace

TEST_CASE("reads give exactly the bytes of the file, in any order, over few connections") {
    TestServer server;
    auto source = open(server.url("/pattern.bin"));
    CHECK(source->sizeBytes() == 0);
    int answered = 0, wrong = 0;
    for (std::uint64_t i = 0; i < 300; ++i) {
        std::uint64_t offset = i * 7919 % 2'900'000, size = 1 + i * 331 % 90'000;
        source->read({offset, size}, [&, offset, size](Result<Bytes> result) {
            ++answered;
            bool fine = result.ok() && result->size() == size;
            for (std::uint64_t b = 0; fine && b < size; b += 97)
                fine = static_cast<char>((*result)[b]) == patternByte(offset + b);
            wrong += !fine;
        });
    }
    while (answered < 300)
        source->pump(std::chrono::milliseconds(100));
    CHECK(wrong == 0);
    CHECK(source->sizeBytes() == TestFolder::patternBytes);
    CHECK(server.server().openConnections() <= 6);
    CHECK(server.logOf(300).size() == 300);
}

TEST_CASE("a read is cut at the end of the file, and one behind it is truncated") {
    TestServer server;
    auto source = open(server.url("/pattern.bin"));
    auto tail = readNow(*source, {TestFolder::patternBytes - 5, 100});
    REQUIRE(tail.ok());
    CHECK(tail->size() == 5);
    auto behind = readNow(*source, {TestFolder::patternBytes, 1});
    REQUIRE_FALSE(behind.ok());
    CHECK(behind.error().code == ErrorCode::truncated);
    CHECK(readNow(*source, {0, 0}).ok());
    CHECK(readNow(*source, {~0ull, 5}).error().code == ErrorCode::invalidArgument);
}

TEST_CASE("a replaced file answers changed") {
    TestServer server;
    auto source = open(server.url("/clouds/town.stipple"));
    REQUIRE(readNow(*source, {0, 64}).ok());
    std::string fresh = server.folder().cloud().string() + ".new";
    writeCloud(fresh, 20'001, 3);
    fs::rename(fresh, server.folder().cloud());
    auto result = readNow(*source, {64, 64});
    REQUIRE_FALSE(result.ok());
    CHECK(result.error().code == ErrorCode::changed);
}

TEST_CASE("a cancelled read is answered as such at the next pump, once") {
    TestServer server;
    auto source = open(server.url("/huge.bin"));
    int answers = 0;
    ErrorCode code{};
    auto id = source->read({0, 1ull << 30}, [&](Result<Bytes> result) {
        ++answers;
        code = result.error().code;
    });
    source->pump(std::chrono::milliseconds(5));
    source->cancel(id);
    source->cancel(id);
    source->pump(std::chrono::milliseconds(0));
    CHECK(answers == 1);
    CHECK(code == ErrorCode::cancelled);
    auto next = readNow(*source, {0, 10}); // goes on working
    CHECK(next.ok());
    auto log = server.logOf(2);
    REQUIRE(log.size() == 2);
    CHECK(log[0].bodyBytes + log[1].bodyBytes < 1ull << 29); // the rest was not fetched
    CHECK(answers == 1);
}

TEST_CASE("destroying a source answers what is open with cancelled, also from inside a completion") {
    TestServer server;
    int cancelled = 0, fine = 0;
    auto count = [&](Result<Bytes> result) { (result.ok() ? fine : cancelled) += 1; };
    auto source = open(server.url("/pattern.bin"));
    for (int i = 0; i < 20; ++i)
        source->read({0, 100}, count);
    source.reset();
    CHECK(cancelled == 20);

    source = open(server.url("/pattern.bin"));
    source->read({0, 10}, [&](Result<Bytes> result) {
        count(std::move(result));
        source.reset();
    });
    for (int i = 0; i < 10; ++i)
        source->read({0, 1'000'000}, count);
    ByteSource* pumped = source.get();
    while (source)
        pumped->pump(std::chrono::milliseconds(100));
    CHECK(fine + cancelled == 31);
    CHECK(fine >= 1);
}

TEST_CASE("a server that is gone is an error, not a wait") {
    auto server = std::make_unique<TestServer>();
    auto source = open(server->url("/pattern.bin"));
    REQUIRE(readNow(*source, {0, 10}).ok());
    server->end();
    auto result = readNow(*source, {10, 10});
    REQUIRE_FALSE(result.ok());
    CHECK(result.error().code == ErrorCode::networkFailed);
    CHECK_FALSE(isTimeout(result.error()));
    CHECK_FALSE(result.error().advice.empty());
}

TEST_CASE("a connection that the server closed in between is opened again") {
    auto limits = TestServer::quickLimits();
    limits.idle = std::chrono::milliseconds(50);
    TestServer server(limits);
    auto source = open(server.url("/pattern.bin"));
    REQUIRE(readNow(*source, {0, 10}).ok());
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    CHECK(readNow(*source, {10, 10}).ok());
}

TEST_CASE("who may not read, and who is to come again later, is told so") {
    CHECK(errorFrom("HTTP/1.1 401 Unauthorized\r\nContent-Length: 0\r\n\r\n") == ErrorCode::accessDenied);
    CHECK(errorFrom("HTTP/1.1 403 Forbidden\r\nContent-Length: 0\r\n\r\n") == ErrorCode::accessDenied);
    FixedServer busy("HTTP/1.1 503 Service Unavailable\r\nRetry-After: 7\r\nContent-Length: 0\r\n\r\n");
    auto result = readNow(*open(busy.url()), {0, 10});
    REQUIRE_FALSE(result.ok());
    CHECK(result.error().code == ErrorCode::networkFailed);
    CHECK(result.error().retryAfterSeconds == 7);
}

TEST_CASE("a date in Retry-After is a pause, counted from the answer's own date") {
    FixedServer busy("HTTP/1.1 503 Service Unavailable\r\nDate: Sun, 06 Nov 1994 08:49:37 GMT\r\n"
                     "Retry-After: Sun, 06 Nov 1994 08:50:07 GMT\r\nContent-Length: 0\r\n\r\n");
    auto result = readNow(*open(busy.url()), {0, 10});
    REQUIRE_FALSE(result.ok());
    CHECK(result.error().retryAfterSeconds == 30);
}

TEST_CASE("a read tells how far its answer has come") {
    FixedServer stuck(
        "HTTP/1.1 206 Partial Content\r\nContent-Range: bytes 0-9/10\r\nContent-Length: 10\r\n\r\n0123",
        false);
    auto source = open(stuck.url());
    auto id = source->read({0, 10}, [](Result<Bytes>) {});
    CHECK_FALSE(source->progress(id).hasBegun);
    for (int i = 0; i < 200 && source->progress(id).bytes < 4; ++i)
        source->pump(std::chrono::milliseconds(10));
    CHECK(source->progress(id).hasBegun);
    CHECK(source->progress(id).bytes == 4);
    source->cancel(id);
    CHECK_FALSE(source->progress(id).hasBegun);
}

TEST_CASE("a source that forgets its version reads the file that is there now") {
    TestServer server;
    auto source = open(server.url("/clouds/town.stipple"));
    REQUIRE(readNow(*source, {0, 64}).ok());
    std::string fresh = server.folder().cloud().string() + ".new";
    writeCloud(fresh, 20'001, 3);
    auto size = fs::file_size(fresh);
    fs::rename(fresh, server.folder().cloud());
    CHECK(readNow(*source, {0, 64}).error().code == ErrorCode::changed);
    REQUIRE(source->forgetVersion());
    REQUIRE(readNow(*source, {0, 64}).ok());
    CHECK(source->sizeBytes() == size);
}

TEST_CASE("what was stored of a version does not come from the server again") {
    TestServer server;
    TemporaryFolder folder;
    std::string url = server.url("/pattern.bin");
    auto counts = std::make_shared<StoredSourceCounts>();
    auto opened = [&] {
        auto store = RangeStore::open(folder.path(), 1 << 30);
        REQUIRE(store.ok());
        auto source = openStoredSource(url, *store, counts);
        REQUIRE(source.ok());
        return std::move(*source);
    };
    auto isRight = [](const Result<Bytes>& bytes, std::uint64_t offset) {
        bool fine = bytes.ok();
        for (std::size_t i = 0; fine && i < bytes->size(); ++i)
            fine = static_cast<char>((*bytes)[i]) == patternByte(offset + i);
        return fine;
    };
    {
        auto source = opened();
        CHECK(isRight(readNow(*source, {0, 100}), 0));
        CHECK(isRight(readNow(*source, {100'000, 300'000}), 100'000));
        CHECK(isRight(readNow(*source, {200'000, 1000}), 200'000));
        CHECK(counts->bytesFromDisk == 1000);
    }
    std::size_t before = server.logOf(2).size();
    CHECK(before == 2);
    auto source = opened();
    CHECK(isRight(readNow(*source, {0, 100}), 0)); // tells the version
    CHECK(isRight(readNow(*source, {100'000, 300'000}), 100'000));
    CHECK(isRight(readNow(*source, {50'000, 400'000}), 50'000)); // its ends are missing
    auto log = server.logOf(4);
    CHECK(log.size() == 4);
}

TEST_CASE("nothing of a version that was stored is given out for another one") {
    TestServer server;
    TemporaryFolder folder;
    auto read = [&](ByteRange range) {
        auto store = RangeStore::open(folder.path(), 1 << 30);
        REQUIRE(store.ok());
        auto source = openStoredSource(server.url("/clouds/town.stipple"), *store, nullptr);
        REQUIRE(source.ok());
        REQUIRE(readNow(**source, {0, 64}).ok());
        auto bytes = readNow(**source, range);
        REQUIRE(bytes.ok());
        return *bytes;
    };
    ByteRange range{1000, 20'000};
    Bytes old = read(range);
    CHECK(read(range) == old);
    std::string fresh = server.folder().cloud().string() + ".new";
    writeCloud(fresh, 20'001, 3);
    fs::rename(fresh, server.folder().cloud());
    std::string file = readFile(server.folder().cloud());
    CHECK(read(range) == Bytes(file.begin() + 1000, file.begin() + 21'000));
    CHECK(read(range) != old);
}

TEST_CASE("a silent server is given up after the time limit") {
    FixedServer silent("", false);
    HttpSourceOptions options;
    options.headerTimeout = std::chrono::milliseconds(200);
    CHECK(isTimeout(readNow(*open(silent.url(), options), {0, 10}).error()));
    FixedServer stuck(
        "HTTP/1.1 206 Partial Content\r\nContent-Range: bytes 0-9/10\r\nContent-Length: 10\r\n\r\n01", false);
    options.noProgressTimeout = std::chrono::milliseconds(200);
    CHECK(isTimeout(readNow(*open(stuck.url(), options), {0, 10}).error()));
}

TEST_CASE("answers that are not what was asked for are refused") {
    const std::string part = "HTTP/1.1 206 Partial Content\r\n";
    CHECK(errorFrom("HTTP/1.1 200 OK\r\nContent-Length: 5000000000\r\n\r\nxxxx") == ErrorCode::unsupported);
    // The first answer: from this server there will never be another.
    CHECK(errorFrom(part + "Content-Length: 10\r\n\r\n0123456789") == ErrorCode::unsupported);
    CHECK(errorFrom(part + "Content-Range: bytes 1-10/20\r\nContent-Length: 10\r\n\r\n0123456789") ==
          ErrorCode::networkFailed);
    CHECK(errorFrom(part + "Content-Range: bytes 0-9/20\r\nContent-Length: 11\r\n\r\n01234567890") ==
          ErrorCode::networkFailed);
    CHECK(errorFrom(part + "Content-Range: bytes 0-9/20\r\nContent-Length: 10\r\n\r\n01234") ==
          ErrorCode::networkFailed);
    CHECK(errorFrom(part + "Content-Range: bytes 0-9/20\r\nTransfer-Encoding: chunked\r\n\r\nff\r\n" +
                    std::string(255, 'x') + "\r\n0\r\n\r\n") == ErrorCode::networkFailed);
    CHECK(
        errorFrom(part +
                  "Content-Range: bytes 0-9/20\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n") ==
        ErrorCode::networkFailed);
    CHECK(errorFrom(part +
                    "Content-Range: bytes 0-9/20\r\nContent-Encoding: gzip\r\nContent-Length: 10\r\n\r\n"
                    "0123456789") == ErrorCode::networkFailed);
    CHECK(errorFrom("HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n") == ErrorCode::notFound);
    CHECK(errorFrom("HTTP/1.1 302 Found\r\nLocation: /y\r\nContent-Length: 0\r\n\r\n") ==
          ErrorCode::networkFailed);
    CHECK(errorFrom("SSH-2.0-OpenSSH_9.2\r\n\r\n") == ErrorCode::networkFailed);
    CHECK(errorFrom("") == ErrorCode::networkFailed);
    std::string endless = "HTTP/1.1 206 Partial Content\r\n";
    for (int i = 0; i < 20'000; ++i)
        endless += "X: 1\r\n";
    CHECK(errorFrom(endless + "Content-Range: bytes 0-9/20\r\nContent-Length: 10\r\n\r\n0123456789") ==
          ErrorCode::networkFailed);
}

TEST_CASE("a whole file that is no longer than the range is taken from a plain server") {
    FixedServer plain("HTTP/1.1 200 OK\r\nContent-Length: 4\r\n\r\nabcd");
    auto result = readNow(*open(plain.url()), {0, 65536});
    REQUIRE(result.ok());
    CHECK(std::string(result->begin(), result->end()) == "abcd");
}

TEST_CASE("addresses are taken apart, and what is none or not http is refused") {
    auto parts = parseHttpUrl("HTTP://[::1]:8017?x=1#part");
    REQUIRE(parts.ok());
    CHECK(parts->host == "::1");
    CHECK(parts->port == "8017");
    CHECK(parts->authority == "[::1]:8017");
    CHECK(parts->target == "/?x=1");
    CHECK(parseHttpUrl("http://host/a/b")->port == "80");
    CHECK(parseHttpUrl("HTTPS://host/a")->port == "443");
    CHECK(parseHttpUrl("https://host/a")->isSecure);
    CHECK(openSource("ftp://host/x").error().code == ErrorCode::unsupported);
    for (const char* url : {"http://", "http:///x", "http://host:0/", "http://host:65536/", "http://host:x/",
                            "http://user@host/", "http://[::1/x", "http://host/a b", "http://host/a\r\nX: y"})
        CHECK(openHttpSource(url).error().code == ErrorCode::invalidArgument);
    CHECK(openSource("/nonexistent/file").error().code == ErrorCode::notFound);
}
