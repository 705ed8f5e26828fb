// `stipple access` and `stipple serve --access` as an operator uses them, with the log beside them.
#include "tests/http/support/program.hpp"
#include "tests/http/support/raw_client.hpp"
#include "tests/http/support/test_server.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

using namespace stipple;
using namespace stipple::test;
namespace fs = std::filesystem;

namespace {

struct Operator {
    TestFolder folder;
    fs::path file = folder.path() / "access.json", errors = folder.path() / "errors.txt";

    // First line of the output; the exit code in front if it is not 0.
    std::string access(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "access");
        arguments.insert(arguments.begin() + 2, file.string());
        Program program(arguments, errors);
        std::string line = program.line();
        int code = program.wait();
        return code == 0 ? line : std::to_string(code) + " " + line;
    }
};

bool isWithin(const std::function<bool()>& condition) {
    for (int i = 0; i < 500 && !condition(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return condition();
}

} // namespace

TEST_CASE("an operator makes clouds private, gives out tokens and signed addresses, and takes them back") {
    Operator me;
    CHECK(me.access({"protect", "town", "survey-*"}) == "private: town survey-*");
    std::string token = me.access({"add", "town", "--name", "Lisa"});
    CHECK(token.size() == 60);
    std::string address = me.access({"sign", "https://maps.example/clouds/town.stipple?x=1", "--for", "1h"});
    std::string prefix = "https://maps.example/clouds/town.stipple?x=1&expires=";
    CHECK(address.substr(0, prefix.size()) == prefix);
    std::string target = me.access({"sign", "town", "--for", "1h"});

    fs::path log = me.folder.path() / "access.log";
    Program program({"serve", me.folder.clouds().string(), "--port", "0", "--json", "--page",
                     me.folder.page().string(), "--access", me.file.string(), "--cors",
                     "https://maps.example", "--log", "combined", "--log-file", log.string()},
                    me.errors);
    std::uint16_t port = portOf(program.line());
    auto status = [&](const std::string& asked, const std::string& fields = "") {
        return askOnce(port, "GET " + asked + " HTTP/1.1\nHost: a\nRange: bytes=0-9" + fields).status;
    };
    const std::string cloud = "/clouds/town.stipple", bearer = "\nAuthorization: Bearer " + token;
    CHECK(status(cloud) == 401);
    CHECK(status(cloud, bearer) == 206);
    CHECK(status(target) == 206);

    CHECK(me.access({"remove", "Lisa"}).empty());
    CHECK(me.access({"new-key"}).empty());
    CHECK(status(cloud, bearer) == 206); // not told yet
    fs::rename(log, log.string() + ".1");
    program.signal(SIGHUP);
    CHECK(isWithin([&] { return status(cloud, bearer) == 401; }));
    CHECK(status(target) == 401);
    CHECK(me.access({"unprotect", "town"}) == "private: survey-*");
    program.signal(SIGHUP);
    CHECK(isWithin([&] { return status(cloud) == 206; }));
    program.signal(SIGTERM);
    CHECK(program.wait() == 0);

    std::string before = readFile(log.string() + ".1"), after = readFile(log);
    CHECK(before.find(" Lisa [") != std::string::npos);
    CHECK(after.find("\" 401 ") != std::string::npos);
    for (const std::string& text : {before, after}) {
        CHECK(text.find(token.substr(17)) == std::string::npos);
        CHECK(text.find(target.substr(target.find("signature=") + 10)) == std::string::npos);
    }
}

TEST_CASE("clouds come to a served folder and leave it without a signal") {
    TestFolder folder;
    Program program(
        {"serve", folder.clouds().string(), "--port", "0", "--json", "--page", folder.page().string()},
        folder.path() / "errors.txt");
    std::uint16_t port = portOf(program.line());
    auto status = [&] { return askOnce(port, "HEAD /clouds/late.stipple HTTP/1.1\nHost: a").status; };
    CHECK(status() == 404);
    fs::copy_file(folder.cloud(), folder.clouds() / "late.stipple");
    CHECK(isWithin([&] { return status() == 200; }));
    fs::remove(folder.clouds() / "late.stipple");
    CHECK(status() == 404);
}

TEST_CASE("mistakes with access files are said, with a code") {
    Operator me;
    CHECK(me.access({"list"}) == "3 "); // there is none
    CHECK(me.access({"protect", "a/b"}) == "2 ");
    CHECK(me.access({"add", "town", "--for", "soon"}) == "2 ");
    CHECK(me.access({"add", "town", "--for", "0d"}) == "2 ");
    CHECK_FALSE(fs::exists(me.file));
    CHECK(me.access({"protect", "*"}) == "private: *");
    CHECK(me.access({"unprotect", "town"}) == "private: *");
    auto json = nlohmann::json::parse(me.access({"list", "--json"}), nullptr, false);
    CHECK(json["public"] == nlohmann::json{"town"});
    CHECK(me.access({"unprotect", "*"}) == "private: none");
    CHECK(me.access({"remove", "nobody"}) == "3 ");
    CHECK(me.access({"sign", "/index.html", "--for", "1h"}) == "2 ");
    CHECK(me.access({"sign", "town"}) == "2 ");
    fs::permissions(me.file, fs::perms(0644));
    CHECK(Program({"serve", me.folder.cloud().string(), "--access", me.file.string()}, me.errors).wait() !=
          0);
    CHECK(readFile(me.errors).find("every user of this machine can read its secrets") != std::string::npos);
    CHECK(Program({"serve", me.folder.cloud().string(), "--cors", "example.org"}, me.errors).wait() != 0);
    CHECK(Program({"serve", me.folder.cloud().string(), "--log", "nonsense"}, me.errors).wait() == 2);
    CHECK(Program({"serve", me.folder.cloud().string(), "--log", "json", "--log-file", "/nonexistent/x"},
                  me.errors)
              .wait() == 4);
}
