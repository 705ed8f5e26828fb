#include "shared/io/scratch_file.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <csignal>
#include <filesystem>
#include <sys/resource.h>
#include <thread>
#include <vector>

using namespace stipple;
using namespace stipple::test;

namespace {
std::unique_ptr<ScratchFile> createOrFail(const std::string& path) {
    auto file = ScratchFile::create(path);
    if (!file)
        FAIL(file.error().sentence());
    return std::move(file).value();
}

Bytes pattern(std::size_t size, std::uint8_t seed) {
    Bytes bytes(size);
    for (std::size_t i = 0; i < size; ++i)
        bytes[i] = static_cast<std::uint8_t>(seed + 31 * i);
    return bytes;
}
} // namespace

TEST_CASE("bytes come back from where they were written", "[scratch]") {
    TemporaryFolder folder;
    auto file = createOrFail(folder.file("s"));
    std::uint64_t a = file->reserve(1000), b = file->reserve(2000);
    CHECK(a == 0);
    CHECK(b == 1000);
    CHECK(file->end() == 3000);
    REQUIRE(file->write(b, pattern(2000, 2)).ok());
    REQUIRE(file->write(a, pattern(1000, 1)).ok());
    Bytes back(1000);
    REQUIRE(file->read(a, back).ok());
    CHECK(back == pattern(1000, 1));
    back.resize(2000);
    REQUIRE(file->read(b, back).ok());
    CHECK(back == pattern(2000, 2));
    CHECK(file->read(0, {}).ok());
    CHECK(file->write(0, {}).ok());
}

TEST_CASE("a scratch file goes with its object unless it was told to stay", "[scratch]") {
    TemporaryFolder folder;
    { auto file = createOrFail(folder.file("gone")); }
    CHECK(folder.fileCount() == 0);
    {
        auto file = createOrFail(folder.file("stays"));
        REQUIRE(file->write(file->reserve(100), pattern(100, 3)).ok());
        file->keep();
    }
    CHECK(folder.fileCount() == 1);
    {
        auto file = ScratchFile::open(folder.file("stays"));
        REQUIRE(file.ok());
        CHECK((*file)->end() == 100); // goes on behind what is there
        Bytes back(100);
        REQUIRE((*file)->read(0, back).ok());
        CHECK(back == pattern(100, 3));
        (*file)->keep();
    }
    createOrFail(folder.file("stays"))->keep(); // a new one of that name is empty
    CHECK(std::filesystem::file_size(folder.file("stays")) == 0);
}

TEST_CASE("a scratch file without a name is nowhere to be seen, and works like any other", "[scratch]") {
    TemporaryFolder folder;
    auto file = ScratchFile::createNameless(folder.file(""));
    REQUIRE(file.ok());
    CHECK(folder.fileCount() == 0);
    REQUIRE((*file)->write((*file)->reserve(1000), pattern(1000, 4)).ok());
    Bytes back(1000);
    REQUIRE((*file)->read(0, back).ok());
    CHECK(back == pattern(1000, 4));
    CHECK(folder.fileCount() == 0);

    auto nowhere = ScratchFile::createNameless(folder.file("none"));
    REQUIRE_FALSE(nowhere.ok());
    CHECK(nowhere.error().code == ErrorCode::writeFailed);
    CHECK(nowhere.error().where == folder.file("none"));
}

TEST_CASE("a scratch file that is not there is absent, one in no folder can't be made", "[scratch]") {
    TemporaryFolder folder;
    auto absent = ScratchFile::open(folder.file("none"));
    REQUIRE_FALSE(absent.ok());
    CHECK(absent.error().code == ErrorCode::notFound);
    CHECK(absent.error().where == folder.file("none"));
    auto nowhere = ScratchFile::create(folder.file("none/s"));
    REQUIRE_FALSE(nowhere.ok());
    CHECK(nowhere.error().code == ErrorCode::writeFailed);
    CHECK(nowhere.error().sentence().find("No such file or directory") != std::string::npos);
}

TEST_CASE("what was discarded reads as zeros or as it was, and its neighbours stay", "[scratch]") {
    TemporaryFolder folder;
    auto file = createOrFail(folder.file("s"));
    constexpr std::size_t part = 1 << 16;
    for (std::uint8_t i = 0; i < 3; ++i)
        REQUIRE(file->write(file->reserve(part), pattern(part, i)).ok());
    file->discard(part, part);
    CHECK(file->end() == 3 * part);
    Bytes back(part);
    REQUIRE(file->read(0, back).ok());
    CHECK((back == pattern(part, 0)));
    REQUIRE(file->read(2 * part, back).ok());
    CHECK((back == pattern(part, 2)));
    REQUIRE(file->read(part, back).ok());
    CHECK((back == Bytes(part) || back == pattern(part, 1)));
}

TEST_CASE("reading beyond the end says at which byte", "[scratch]") {
    TemporaryFolder folder;
    auto file = createOrFail(folder.file("s"));
    REQUIRE(file->write(file->reserve(10), pattern(10, 0)).ok());
    Bytes back(11);
    Status read = file->read(0, back);
    REQUIRE_FALSE(read.ok());
    CHECK(read.error().code == ErrorCode::truncated);
    CHECK(read.error().what.find("byte 10") != std::string::npos);
    CHECK(read.error().where == folder.file("s"));
}

TEST_CASE("many threads reserve and write side by side", "[scratch]") {
    TemporaryFolder folder;
    auto file = createOrFail(folder.file("s"));
    constexpr std::size_t threads = 4, each = 200, size = 777;
    std::vector<std::vector<std::uint64_t>> offsets(threads);
    std::vector<std::thread> workers;
    std::atomic<bool> failed{false};
    for (std::size_t t = 0; t < threads; ++t)
        workers.emplace_back([&, t] {
            for (std::size_t i = 0; i < each; ++i) {
                offsets[t].push_back(file->reserve(size));
                if (!file->write(offsets[t].back(), pattern(size, static_cast<std::uint8_t>(t + 4 * i))))
                    failed = true;
            }
        });
    for (std::thread& worker : workers)
        worker.join();
    CHECK_FALSE(failed);
    CHECK(file->end() == threads * each * size);
    std::size_t wrong = 0;
    Bytes back(size);
    for (std::size_t t = 0; t < threads; ++t)
        for (std::size_t i = 0; i < each; ++i)
            wrong += file->read(offsets[t][i], back).ok() &&
                             back == pattern(size, static_cast<std::uint8_t>(t + 4 * i))
                         ? 0
                         : 1;
    CHECK(wrong == 0);
}

TEST_CASE("a full disk is said, and what to do", "[scratch]") {
    TemporaryFolder folder;
    std::filesystem::create_symlink("/dev/full", folder.file("s"));
    auto file = createOrFail(folder.file("s"));
    Status written = file->write(0, pattern(10, 0));
    REQUIRE_FALSE(written.ok());
    CHECK(written.error().code == ErrorCode::writeFailed);
    CHECK(written.error().sentence().find("No space left on device") != std::string::npos);
    CHECK(written.error().advice.find("free space") != std::string::npos);
    CHECK(written.error().where == folder.file("s"));
}

TEST_CASE("a limit on the size of files is an error like any other", "[scratch]") {
    TemporaryFolder folder;
    auto file = createOrFail(folder.file("s"));
    auto before = std::signal(SIGXFSZ, SIG_IGN);
    struct rlimit old {};
    REQUIRE(::getrlimit(RLIMIT_FSIZE, &old) == 0);
    struct rlimit small {
        4096, old.rlim_max
    };
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &small) == 0);
    Status written = file->write(0, pattern(10000, 0));
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &old) == 0);
    std::signal(SIGXFSZ, before);
    REQUIRE_FALSE(written.ok());
    CHECK(written.error().code == ErrorCode::writeFailed);
    CHECK(written.error().sentence().find("File too large") != std::string::npos);
    CHECK(file->write(0, pattern(10000, 0)).ok()); // goes on once it may
}
