// https: the same answers through TLS, who is let in, and what becomes of certificates.
#include "server/net/tls_context.hpp"
#include "tests/http/support/raw_client.hpp"
#include "tests/http/support/test_certificate.hpp"
#include "tests/http/support/test_server.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

using namespace stipple;
using namespace stipple::test;
namespace fs = std::filesystem;

namespace {

constexpr int tls11 = 0x0302, tls12 = 0x0303;

std::string rangeOf(const std::string& target, std::uint64_t first, std::uint64_t last) {
    return "GET " + target + " HTTP/1.1\nHost: a\nRange: bytes=" + std::to_string(first) + "-" +
           std::to_string(last);
}

std::size_t wrongBytes(const std::string& body, std::uint64_t first) {
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < body.size(); ++i)
        wrong += body[i] != patternByte(first + i);
    return wrong;
}

// What loading these two files says.
Error loadError(const std::string& certificate, const std::string& key) {
    auto loaded = server::TlsContext::load(certificate, key);
    REQUIRE_FALSE(loaded);
    return loaded.error();
}

} // namespace

TEST_CASE("ranges of every size arrive through TLS byte for byte, one connection for all") {
    TestServer server(TestServer::Https{});
    CHECK(server.url("/").starts_with("https://127.0.0.1:"));
    RawClient client(server.port());
    REQUIRE(client.startTls());
    CHECK(client.tlsVersion() == "TLSv1.3");
    CHECK(client.tlsProtocol() == "http/1.1");
    for (auto [first, size] :
         {std::pair{0ull, 1ull}, {0, 16384}, {1, 65536}, {7, 65537}, {12345, 2'000'000}, {0, 3'000'000}}) {
        auto response = client.ask(rangeOf("/pattern.bin", first, first + size - 1));
        REQUIRE(response.status == 206);
        REQUIRE(response.body.size() == size);
        CHECK(wrongBytes(response.body, first) == 0);
    }
    auto last = client.ask("GET / HTTP/1.1\nHost: a\nConnection: close");
    CHECK(last.status == 200);
    CHECK(client.isClosedWithin(2000));
    CHECK(client.wasTold());
}

TEST_CASE("requests that are pipelined through TLS are answered in order") {
    TestServer server(TestServer::Https{});
    RawClient client(server.port());
    REQUIRE(client.startTls({}, tls12));
    CHECK(client.tlsVersion() == "TLSv1.2");
    CHECK(client.tlsProtocol().empty());
    std::string requests;
    for (int i = 0; i < 40; ++i)
        requests += "GET /pattern.bin HTTP/1.1\r\nHost: a\r\nRange: bytes=" + std::to_string(i * 10) + "-" +
                    std::to_string(i * 10 + 9) + "\r\n\r\n";
    REQUIRE(client.send(requests));
    std::size_t wrong = 0;
    for (std::uint64_t i = 0; i < 40; ++i) {
        auto response = client.receive();
        wrong += response.body.size() != 10 || wrongBytes(response.body, i * 10) > 0;
    }
    CHECK(wrong == 0);
}

TEST_CASE("old versions, other protocols and plain http are refused") {
    TestServer server(TestServer::Https{});
    CHECK_FALSE(RawClient(server.port()).startTls({"http/1.1"}, tls11));
    CHECK_FALSE(RawClient(server.port()).startTls({"h2"}));
    RawClient both(server.port());
    REQUIRE(both.startTls({"h2", "http/1.1"}));
    CHECK(both.tlsProtocol() == "http/1.1");
    RawClient plain(server.port());
    auto response = plain.ask("GET / HTTP/1.1\nHost: a");
    CHECK(response.status == 400);
    CHECK(response.body.find("https") != std::string::npos);
    CHECK(plain.isClosedWithin(3000));
}

TEST_CASE("a client that does not finish its handshake is cut at the header's time") {
    auto limits = TestServer::quickLimits();
    limits.header = std::chrono::milliseconds(300);
    TestServer server(TestServer::Https{}, limits);
    RawClient silent(server.port()), half(server.port());
    half.send(std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11));
    CHECK(silent.isClosedWithin(3000));
    CHECK(half.isClosedWithin(3000));
}

TEST_CASE("a client that leaves in the middle of a handshake or of an answer does no harm") {
    TestServer server(TestServer::Https{});
    for (int i = 0; i < 20; ++i) {
        RawClient left(server.port());
        left.send(std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 1 + i % 11));
    }
    for (int i = 0; i < 5; ++i) {
        RawClient left(server.port());
        REQUIRE(left.startTls());
        left.send("GET /huge.bin HTTP/1.1\r\nHost: a\r\n\r\n");
    }
    RawClient client(server.port());
    REQUIRE(client.startTls());
    CHECK(client.ask("GET / HTTP/1.1\nHost: a").status == 200);
}

TEST_CASE(
    "a file that is cut under a download through TLS ends it short, and the client is not told that is all") {
    TestServer server(TestServer::Https{});
    RawClient client(server.port());
    client.setReceiveBuffer(65536);
    REQUIRE(client.startTls());
    client.send("GET /huge.bin HTTP/1.1\r\nHost: a\r\n\r\n");
    while (server.server().openConnections() < 1)
        std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    fs::resize_file(server.folder().page() / "huge.bin", 1000);
    auto response = client.receive();
    CHECK(response.status == 200);
    CHECK_FALSE(response.isComplete);
    CHECK_FALSE(client.wasTold());
    CHECK_FALSE(server.logOf(1)[0].isComplete);
}

TEST_CASE("a new certificate is for new connections; those that are open go on") {
    TestServer server(TestServer::Https{});
    RawClient before(server.port());
    REQUIRE(before.startTls());
    CHECK(before.peerName() == "first");
    CHECK(before.ask("GET / HTTP/1.1\nHost: a").status == 200);
    TestCertificate second = makeCertificate(server.folder().path(), "second");

    fs::copy_file(second.certificatePath, server.certificate().certificatePath,
                  fs::copy_options::overwrite_existing);
    Status mismatch = server.server().reloadCertificate(); // the key is still the first one's
    REQUIRE_FALSE(mismatch);
    CHECK(mismatch.error().what.find("does not belong") != std::string::npos);
    RawClient meanwhile(server.port());
    REQUIRE(meanwhile.startTls());
    CHECK(meanwhile.peerName() == "first");

    fs::copy_file(second.keyPath, server.certificate().keyPath, fs::copy_options::overwrite_existing);
    REQUIRE(server.server().reloadCertificate());
    RawClient after(server.port());
    REQUIRE(after.startTls());
    CHECK(after.peerName() == "second");
    for (RawClient* client : {&before, &meanwhile, &after})
        CHECK(client->ask("GET / HTTP/1.1\nHost: a").status == 200);
}

TEST_CASE("certificates and keys that can't be used are named with the reason") {
    TestFolder folder;
    TestCertificate good = makeCertificate(folder.path(), "good"),
                    other = makeCertificate(folder.path(), "other");
    CHECK(server::TlsContext::load(good.certificatePath, good.keyPath));

    Error missing = loadError("/nonexistent.pem", good.keyPath);
    CHECK(missing.code == ErrorCode::notFound);
    CHECK(missing.where == "/nonexistent.pem");
    CHECK(loadError(good.certificatePath, "/nonexistent.pem").code == ErrorCode::notFound);

    Error mismatch = loadError(good.certificatePath, other.keyPath);
    CHECK(mismatch.where == other.keyPath);
    CHECK(mismatch.what.find("does not belong to the certificate") != std::string::npos);

    std::string encrypted = (folder.path() / "encrypted.key").string();
    runOpenSsl("pkey -in " + good.keyPath + " -aes256 -passout pass:secret -out " + encrypted);
    Error locked = loadError(good.certificatePath, encrypted);
    CHECK(locked.what.find("encrypted") != std::string::npos);
    CHECK(locked.advice.find("openssl pkey") != std::string::npos);

    CHECK(loadError(good.keyPath, good.keyPath).what.find("no certificate") != std::string::npos);
    CHECK(loadError(good.certificatePath, good.certificatePath).what.find("no private key") !=
          std::string::npos);
    std::string garbage = (folder.path() / "garbage.pem").string();
    std::ofstream(garbage) << "nonsense";
    CHECK(loadError(garbage, good.keyPath).what.find("no certificate") != std::string::npos);
    CHECK(loadError(good.certificatePath, garbage).what.find("no private key") != std::string::npos);
    CHECK(loadError(folder.path().string(), good.keyPath).where == folder.path().string());
}
