// `stipple serve` as a program: its line, its log, its errors, its end, and its life without descriptors.
#include "tests/http/support/program.hpp"
#include "tests/http/support/raw_client.hpp"
#include "tests/http/support/test_certificate.hpp"
#include "tests/http/support/test_server.hpp"

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace stipple;
using namespace stipple::test;
namespace fs = std::filesystem;

TEST_CASE("serve prints one line, logs each request, and ends with success on a signal") {
    TestFolder folder;
    fs::path errors = folder.path() / "errors.txt";
    std::ofstream(folder.path() / "broken.stipple") << "nonsense";
    Program program({"serve", folder.clouds().string(), (folder.path() / "broken.stipple").string(), "--port",
                     "0", "--json", "--log", "json", "--page", folder.page().string()},
                    errors);
    auto json = nlohmann::json::parse(program.line(), nullptr, false);
    REQUIRE(json.is_object());
    auto port = json["port"].get<std::uint16_t>();
    CHECK(json["clouds"].size() == 1);
    CHECK(json["clouds"][0]["address"] == json["address"].get<std::string>() + "clouds/town.stipple");
    CHECK(askOnce(port, "GET /clouds/town.stipple HTTP/1.1\nHost: a\nRange: bytes=0-99").status == 206);
    CHECK(askOnce(port, "GET /x\x80y HTTP/1.1\nHost: a").status != 200);
    program.signal(SIGTERM);
    CHECK(program.wait() == 0);
    std::string text = readFile(errors);
    CHECK(text.find("warning: ") != std::string::npos);
    CHECK(text.find("broken.stipple") != std::string::npos);
    CHECK(text.find(R"("target":"/clouds/town.stipple","version":"1.1","range":"bytes=0-99")") !=
          std::string::npos);
    CHECK(text.find(R"("status":206,"bytes":100,)") != std::string::npos);
}

TEST_CASE("a server for this machine alone is read by the pages of no other origin, unless they are listed") {
    TestFolder folder;
    auto allowed = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"serve", folder.cloud().string(), "--port", "0", "--json", "--page",
                                         folder.page().string()});
        Program program(options, folder.path() / "errors.txt");
        auto answer =
            askOnce(portOf(program.line()),
                    "GET /clouds/town.stipple HTTP/1.1\nHost: a\nRange: bytes=0-9\nOrigin: https://a");
        CHECK(answer.status == 206);
        return answer.field("access-control-allow-origin") + ", " +
               answer.field("cross-origin-resource-policy");
    };
    CHECK(allowed({}) == ", same-origin");
    CHECK(allowed({"--cors", "https://a"}) == "https://a, same-origin");
    CHECK(allowed({"--cors", "*"}) == "*, cross-origin");
    CHECK(allowed({"--trust-proxy", "127.0.0.1"}) == "*, cross-origin");
    CHECK(allowed({"--host", "0.0.0.0"}) == "*, cross-origin");
}

TEST_CASE("render names the connection that is refused, however little time it has") {
    TestFolder folder;
    fs::path errors = folder.path() / "errors.txt", picture = folder.path() / "a.png";
    std::uint16_t port = 0;
    {
        TestServer gone;
        port = gone.port();
    }
    std::string address = "http://127.0.0.1:" + std::to_string(port) + "/clouds/town.stipple";
    Program program({"render", address, "-o", picture.string(), "--timeout", "0.2"}, errors);
    CHECK(program.wait() != 0);
    std::string text = readFile(errors);
    CHECK(text.find("can't connect: Connection refused") != std::string::npos);
    CHECK(text.find(address) != std::string::npos);
    CHECK_FALSE(fs::exists(picture));
}

TEST_CASE("a second signal does not wait for the client that is still reading") {
    TestFolder folder;
    Program program(
        {"serve", folder.cloud().string(), "--port", "0", "--json", "--page", folder.page().string()},
        folder.path() / "errors.txt");
    RawClient client(portOf(program.line()));
    client.setReceiveBuffer(4096);
    client.send("GET /huge.bin HTTP/1.1\r\nHost: a\r\n\r\n");
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    program.signal(SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    auto begin = std::chrono::steady_clock::now();
    program.signal(SIGINT);
    CHECK(program.wait() == 0);
    CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(5));
}

TEST_CASE("serve refuses what it can't serve, with a sentence and a code") {
    TestFolder folder;
    fs::path errors = folder.path() / "errors.txt";
    std::ofstream(folder.path() / "broken.stipple") << "nonsense";
    CHECK(Program({"serve", "/nonexistent"}, errors).wait() == 3);
    CHECK(readFile(errors) == "stipple serve: /nonexistent: there is no such file or folder\n");
    CHECK(Program({"serve", (folder.path() / "broken.stipple").string()}, errors).wait() == 3);
    CHECK(readFile(errors).find("broken.stipple") != std::string::npos);
    CHECK(Program({"serve", folder.cloud().string(), "--page", "/nonexistent"}, errors).wait() == 3);
    CHECK(Program({"serve"}, errors).wait() == 2);
    CHECK(Program({"serve", folder.cloud().string(), "--port", "70000"}, errors).wait() == 2);
    for (const char* option :
         {"--upstream-token-file", "--upstream-ca"}) { // though no cloud comes from elsewhere
        INFO(option);
        int code = Program({"serve", folder.cloud().string(), option, "/nonexistent"}, errors).wait();
        CHECK((code == 2 || code == 3));
        CHECK(readFile(errors).find("/nonexistent") != std::string::npos);
    }
    TestServer other;
    CHECK(
        Program({"serve", folder.cloud().string(), "--port", std::to_string(other.port())}, errors).wait() ==
        6);
    CHECK(readFile(errors).find("--port") != std::string::npos);
}

TEST_CASE("a trusted proxy's clients are told apart, and nobody else's word is taken") {
    TestFolder folder;
    fs::path errors = folder.path() / "errors.txt";
    Program program({"serve", folder.cloud().string(), "--port", "0", "--json", "--log", "combined",
                     "--trust-proxy", "127.0.0.2", "127.0.0.3", "--connections-per-client", "1"},
                    errors);
    std::uint16_t port = portOf(program.line());
    auto askFrom = [&](const char* from, const std::string& forwarded) {
        RawClient client(port, from);
        CHECK(client.ask("GET /api/v1/clouds HTTP/1.1\nHost: a\nX-Forwarded-For: " + forwarded).status ==
              200);
    };
    RawClient open(port, "127.0.0.2");
    CHECK(open.ask("GET /api/v1/clouds HTTP/1.1\nHost: a").status == 200);
    askFrom("127.0.0.2", "6.6.6.6, 192.0.2.7, 127.0.0.3");
    askFrom("127.0.0.4", "192.0.2.8");
    program.signal(SIGTERM);
    CHECK(program.wait() == 0);
    std::string log = readFile(errors);
    CHECK(log.find("192.0.2.7 - ") != std::string::npos);
    CHECK(log.find("127.0.0.4 - ") != std::string::npos);
    CHECK(log.find("192.0.2.8 - ") == std::string::npos);
    CHECK(log.find("6.6.6.6 - ") == std::string::npos);
    CHECK(Program({"serve", folder.cloud().string(), "--trust-proxy", "my-proxy"}, errors).wait() == 2);
}

TEST_CASE("serve speaks https with --cert and --key, and reads them again on SIGHUP") {
    TestFolder folder;
    fs::path errors = folder.path() / "errors.txt";
    TestCertificate used = makeCertificate(folder.path(), "first"),
                    other = makeCertificate(folder.path(), "second");
    auto arguments = [&](const std::string& key) {
        return std::vector<std::string>{"serve",  folder.cloud().string(), "--port", "0", "--json",
                                        "--cert", used.certificatePath,    "--key",  key};
    };
    CHECK(Program(arguments(other.keyPath), errors).wait() == 2);
    CHECK(readFile(errors).find("the key does not belong to the certificate") != std::string::npos);
    CHECK(Program({"serve", folder.cloud().string(), "--cert", used.certificatePath}, errors).wait() == 2);

    Program program(arguments(used.keyPath), errors);
    std::string line = program.line();
    CHECK(line.find("\"address\":\"https://") != std::string::npos);
    std::uint16_t port = portOf(line);
    auto nameNow = [&] {
        RawClient client(port);
        REQUIRE(client.startTls());
        CHECK(client.ask("GET /api/v1/clouds HTTP/1.1\nHost: a").status == 200);
        return client.peerName();
    };
    auto isWithin = [](const std::function<bool()>& condition) {
        for (int i = 0; i < 200 && !condition(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return condition();
    };
    CHECK(nameNow() == "first");
    fs::copy_file(other.certificatePath, used.certificatePath, fs::copy_options::overwrite_existing);
    program.signal(SIGHUP);
    CHECK(isWithin([&] { return readFile(errors).find("not reloaded") != std::string::npos; }));
    CHECK(nameNow() == "first");
    fs::copy_file(other.keyPath, used.keyPath, fs::copy_options::overwrite_existing);
    program.signal(SIGHUP);
    CHECK(isWithin([&] { return nameNow() == "second"; }));
    program.signal(SIGTERM);
    CHECK(program.wait() == 0);
}

// UBSan's check of virtual tables opens a pipe to see whether memory can be read, and takes a failure for a
// wrong table: a process without descriptors can't be judged by it.
#ifndef __SANITIZE_ADDRESS__
TEST_CASE("a server that runs out of descriptors recovers when clients leave") {
    TestFolder folder;
    Program program(
        {"serve", folder.cloud().string(), "--port", "0", "--json", "--page", folder.page().string()},
        folder.path() / "errors.txt", 40);
    std::uint16_t port = portOf(program.line());
    std::vector<std::unique_ptr<RawClient>> clients;
    for (int i = 0; i < 100; ++i)
        clients.push_back(std::make_unique<RawClient>(port));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    double before = program.cpuSeconds();
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    CHECK(program.cpuSeconds() - before < 0.1); // it does not spin on the clients that it can't accept
    // One of those that were let in finds no descriptor left for a file.
    auto busy = clients.front()->ask("GET /index.html HTTP/1.1\nHost: a");
    CHECK((busy.status == 503 || busy.status == 200));
    clients.clear();
    int status = 0;
    for (int i = 0; i < 50 && status != 200; ++i)
        status = askOnce(port, "GET /index.html HTTP/1.1\nHost: a").status;
    CHECK(status == 200);
    program.signal(SIGTERM);
    CHECK(program.wait() == 0);
}
#endif
