#include "server/log/access_log.hpp"

#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <sys/stat.h>
#include <thread>

using namespace stipple;
using namespace stipple::server;
using namespace stipple::test;

namespace {

RequestRecord record(int status) {
    RequestRecord made;
    made.method = "GET";
    made.target = "/";
    made.status = status;
    return made;
}

std::unique_ptr<AccessLog> open(const std::string& path, LogFormat format = LogFormat::json) {
    auto log = AccessLog::open(format, path);
    REQUIRE(log.ok());
    return std::move(*log);
}

std::size_t linesWith(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

} // namespace

TEST_CASE("a log is appended to, and not readable to everybody") {
    TemporaryFolder folder;
    std::string path = folder.file("access.log");
    open(path)->write(record(200));
    open(path, LogFormat::combined)->write(record(404));
    std::string text = fileText(path);
    CHECK(linesWith(text, "\n") == 2);
    CHECK(text.find("\"status\":200") < text.find(" 404 "));
    struct stat status {};
    REQUIRE(::stat(path.c_str(), &status) == 0);
    CHECK((status.st_mode & 0007) == 0);
}

TEST_CASE("a log that was moved away goes on under its name once it is reopened") {
    TemporaryFolder folder;
    std::string path = folder.file("access.log");
    auto log = open(path);
    log->write(record(200));
    std::filesystem::rename(path, folder.file("access.log.1"));
    log->write(record(206));
    REQUIRE(log->reopen().ok());
    log->write(record(304));
    CHECK(linesWith(fileText(folder.file("access.log.1")), "\n") == 2);
    CHECK(linesWith(fileText(path), "\"status\":304") == 1);
}

TEST_CASE("a log that can't be reopened goes on in the old file") {
    TemporaryFolder folder;
    std::filesystem::create_directory(folder.file("logs"));
    std::string path = folder.file("logs/access.log");
    auto log = open(path);
    std::filesystem::rename(folder.file("logs"), folder.file("old"));
    Status status = log->reopen();
    REQUIRE_FALSE(status.ok());
    CHECK(status.error().sentence().find(path) != std::string::npos);
    log->write(record(200));
    CHECK(linesWith(fileText(folder.file("old/access.log")), "\n") == 1);
    CHECK(AccessLog::open(LogFormat::json, "/nonexistent/access.log").error().code == ErrorCode::writeFailed);
}

TEST_CASE("lines of many threads stay whole, also while the log is reopened") {
    TemporaryFolder folder;
    std::string path = folder.file("access.log");
    auto log = open(path);
    constexpr int threads = 4, each = 500;
    std::vector<std::thread> writers;
    for (int i = 0; i < threads; ++i)
        writers.emplace_back([&] {
            for (int n = 0; n < each; ++n)
                log->write(record(200));
        });
    for (int i = 0; i < 20; ++i)
        REQUIRE(log->reopen().ok());
    for (std::thread& writer : writers)
        writer.join();
    std::string text = fileText(path);
    CHECK(linesWith(text, "\n") == threads * each);
    CHECK(linesWith(text, "{\"time\":") == threads * each);
    CHECK(linesWith(text, "\"complete\":true}\n") == threads * each);
}

TEST_CASE("a full disk loses lines, nothing else") {
    open("/dev/full")->write(record(200));
    open("/dev/full", LogFormat::combined)->write(record(200));
    CHECK(open("/dev/full")->reopen().ok());
}
