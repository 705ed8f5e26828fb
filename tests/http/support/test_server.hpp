// A real server on a free port of 127.0.0.1, over a folder of its own: one cloud (town.stipple), and a page
// with files of known content, among them a sparse one beyond 2^32 bytes. Its log is kept.
#pragma once

#include "server/net/server.hpp"

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace stipple::test {

// A cloud of `points` random points, different for each seed.
void writeCloud(const std::string& path, std::size_t points, std::uint32_t seed);
std::string readFile(const std::filesystem::path& path);
// Byte `offset` of page/pattern.bin.
char patternByte(std::uint64_t offset);

// A folder with page/ and clouds/town.stipple in it, removed at the end.
class TestFolder {
  public:
    TestFolder();
    ~TestFolder();
    std::filesystem::path path() const { return path_; }
    std::filesystem::path page() const { return path_ / "page"; }
    std::filesystem::path cloud() const { return path_ / "clouds" / "town.stipple"; }

    static constexpr std::uint64_t patternBytes = 3'000'000;     // page/pattern.bin
    static constexpr std::uint64_t hugeBytes = (5ull << 30) + 7; // page/huge.bin: zeros, but for the marks
    static constexpr const char* mark = "MARK";                  // at 2^31 - 2, 2^32 - 2 and the end - 4

  private:
    std::filesystem::path path_;
};

class TestServer {
  public:
    explicit TestServer(server::ServerLimits limits = quickLimits());
    static server::ServerLimits quickLimits(); // as in service, but looked at every 20 ms

    std::uint16_t port() const { return server_->port(); }
    std::string url(const std::string& target) const { return server_->address() + target.substr(1); }
    server::Server& server() { return *server_; }
    TestFolder& folder() { return folder_; }
    std::vector<server::RequestRecord> log() const;
    // Waits until `count` requests are logged (a record comes after the client has its answer).
    std::vector<server::RequestRecord> logOf(std::size_t count) const;
    void end() { server_.reset(); } // as if the program had been killed

  private:
    TestFolder folder_;
    mutable std::mutex mutex_;
    std::vector<server::RequestRecord> records_;
    std::unique_ptr<server::Server> server_;
};

} // namespace stipple::test
