#include "tests/http/support/test_server.hpp"

#include "server/site/site.hpp"
#include "shared/format/cloud_writer.hpp"

#include <catch2/catch.hpp>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <random>
#include <sys/stat.h>
#include <thread>

namespace stipple::test {

namespace fs = std::filesystem;

namespace {
template <class T>
T need(Result<T> result) {
    if (!result.ok())
        FAIL(result.error().sentence());
    return std::move(result).value();
}
} // namespace

void writeCloud(const std::string& path, std::size_t points, std::uint32_t seed) {
    CloudMetadata metadata;
    metadata.name = "Town";
    metadata.rootCube = {{0, 0, 0}, 20};
    metadata.spacing = 1;
    metadata.pointCount = points;
    std::mt19937 random(seed);
    PointBatch batch;
    batch.resize(metadata.schema, points);
    for (Vec3i& position : batch.positions) {
        for (int axis = 0; axis < 3; ++axis)
            position[axis] = static_cast<std::int64_t>(random() & 0xFFFFF);
        metadata.bounds.extend(position);
    }
    auto writer = need(CloudWriter::create(path));
    if (Status status = writer->add(need(encodeNode(metadata, NodeKey{}, batch))); !status)
        FAIL(status.error().sentence());
    need(writer->finish(metadata));
}

std::string readFile(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

char patternByte(std::uint64_t offset) {
    return static_cast<char>((offset * 2654435761u) >> 16);
}

// "line 00" to "line 99", 8 bytes each.
static std::string hundredLines() {
    std::string text;
    for (int i = 0; i < 100; ++i)
        text += "line " + std::to_string(i / 10) + std::to_string(i % 10) + "\n";
    return text;
}

TestFolder::TestFolder() {
    std::string pattern = (fs::temp_directory_path() / "stipple-http-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
    fs::create_directories(page() / "assets");
    fs::create_directories(path_ / "clouds");
    std::ofstream(page() / "index.html") << "<!doctype html><title>test</title>";
    std::ofstream(page() / "assets" / "app-A1b2C3d4.js") << "export {};";
    for (const char* coding : {"br", "zst", "gz"})
        std::ofstream(page() / "assets" / (std::string("app-A1b2C3d4.js.") + coding))
            << coding << " of export {};";
    std::ofstream(page() / "letters.txt") << "abcdefghijklmnopqrstuvwxyz";
    for (const char* name : {"lines.txt", "assets/lines-A1b2C3d4.js", "assets/lines-A1b2C3d4.js.br"})
        std::ofstream(page() / name) << hundredLines();
    std::ofstream(page() / "core.wasm") << std::string("\0asm", 4);
    std::ofstream(page() / "empty.txt");
    std::ofstream(path_ / "secret.txt") << "secret";
    fs::create_symlink("../secret.txt", page() / "link.txt");
    {
        std::string bytes(patternBytes, '\0');
        for (std::uint64_t i = 0; i < patternBytes; ++i)
            bytes[i] = patternByte(i);
        std::ofstream(page() / "pattern.bin", std::ios::binary) << bytes;
    }
    std::ofstream(page() / "huge.bin").close();
    fs::resize_file(page() / "huge.bin", hugeBytes);
    std::fstream huge(page() / "huge.bin", std::ios::in | std::ios::out | std::ios::binary);
    for (std::uint64_t at : {(std::uint64_t{1} << 31) - 2, (std::uint64_t{1} << 32) - 2, hugeBytes - 4})
        huge.seekp(static_cast<std::streamoff>(at)).write(mark, 4);
    huge.close();
    writeCloud(cloud().string(), 20'000, 1);
    for (const auto& entry : fs::recursive_directory_iterator(path_))
        if (entry.is_regular_file())
            setChangedTime(entry.path(), changedSeconds);
}

void setChangedTime(const fs::path& path, std::int64_t seconds) {
    struct timespec times[2] = {{0, UTIME_OMIT}, {seconds, 0}};
    REQUIRE(::utimensat(AT_FDCWD, path.c_str(), times, 0) == 0);
}

TestFolder::~TestFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

server::ServerLimits TestServer::quickLimits() {
    server::ServerLimits limits;
    limits.sweep = std::chrono::milliseconds(20);
    return limits;
}

TestServer::TestServer(server::ServerLimits limits, const Prepare& prepare) {
    start(limits, prepare ? prepare(folder_) : server::SiteOptions());
}

TestServer::TestServer(Https, server::ServerLimits limits)
    : certificate_(makeCertificate(folder_.path(), "first")) {
    start(limits, {});
}

void TestServer::start(server::ServerLimits limits, server::SiteOptions siteOptions) {
    auto catalog = need(server::CloudCatalog::open({folder_.clouds().string()}));
    auto page = need(server::openPageFolder(folder_.page().string()));
    auto site = std::make_shared<const server::Site>(std::move(catalog.catalog),
                                                     server::Page(std::move(page)), std::move(siteOptions));
    server::ServerOptions options;
    options.limits = limits;
    options.threads = 2;
    options.certificatePath = certificate_.certificatePath;
    options.keyPath = certificate_.keyPath;
    server_ = need(server::Server::start(options, site, [this](const server::RequestRecord& record) {
        std::lock_guard lock(mutex_);
        records_.push_back(record);
    }));
}

std::vector<server::RequestRecord> TestServer::log() const {
    std::lock_guard lock(mutex_);
    return records_;
}

std::vector<server::RequestRecord> TestServer::logOf(std::size_t count) const {
    for (int i = 0; i < 500 && log().size() < count; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return log();
}

} // namespace stipple::test
