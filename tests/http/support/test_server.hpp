// A real server on a free port of 127.0.0.1, over a folder of its own: one cloud (town.stipple), and a page
// with files of known content, among them a sparse one beyond 2^32 bytes, and one in every content coding.
// All files were changed last at 1994-11-06 08:49:37. Its log is kept.
#pragma once

#include "server/net/server.hpp"
#include "server/site/site.hpp"
#include "tests/http/support/test_certificate.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace stipple::test {

// A cloud of `points` random points, different for each seed.
void writeCloud(const std::string& path, std::size_t points, std::uint32_t seed);
std::string readFile(const std::filesystem::path& path);
void setChangedTime(const std::filesystem::path& path, std::int64_t seconds); // since 1970
// Byte `offset` of page/pattern.bin.
char patternByte(std::uint64_t offset);

// A folder with page/ and clouds/town.stipple in it, removed at the end.
class TestFolder {
  public:
    TestFolder();
    ~TestFolder();
    std::filesystem::path path() const { return path_; }
    std::filesystem::path page() const { return path_ / "page"; }
    std::filesystem::path clouds() const { return path_ / "clouds"; }
    std::filesystem::path cloud() const { return clouds() / "town.stipple"; }

    static constexpr std::int64_t changedSeconds = 784'111'777;  // 1994-11-06 08:49:37 UTC
    static constexpr std::uint64_t patternBytes = 3'000'000;     // page/pattern.bin
    static constexpr std::uint64_t hugeBytes = (5ull << 30) + 7; // page/huge.bin: zeros, but for the marks
    static constexpr const char* mark = "MARK";                  // at 2^31 - 2, 2^32 - 2 and the end - 4

  private:
    std::filesystem::path path_;
};

class TestServer {
  public:
    // `prepare` may add to the folder, of which all of clouds/ is served.
    using Prepare = std::function<server::SiteOptions(TestFolder& folder)>;
    explicit TestServer(server::ServerLimits limits = quickLimits(), const Prepare& prepare = {});
    // An https server; certificates that are made in its folder are found by reload.
    struct Https {};
    explicit TestServer(Https, server::ServerLimits limits = quickLimits());
    const TestCertificate& certificate() const { return certificate_; }
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
    void start(server::ServerLimits limits, server::SiteOptions siteOptions);

    TestFolder folder_;
    TestCertificate certificate_; // empty: http
    mutable std::mutex mutex_;
    std::vector<server::RequestRecord> records_;
    std::unique_ptr<server::Server> server_;
};

} // namespace stipple::test
