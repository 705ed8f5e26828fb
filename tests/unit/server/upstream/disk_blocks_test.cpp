#include "server/upstream/disk_blocks.hpp"

#include "shared/base/text.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <sys/stat.h>
#include <thread>
#include <vector>

using namespace stipple;
using namespace stipple::server;
using namespace stipple::test;
namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t plenty = 1 << 20;

std::unique_ptr<DiskBlocks> opened(const std::string& folder, std::uint64_t maxBytes = plenty) {
    auto blocks = DiskBlocks::open(folder, maxBytes);
    if (!blocks.ok())
        FAIL(blocks.error().sentence());
    return std::move(*blocks);
}

Bytes block(int seed, std::size_t size = 1000) {
    Bytes bytes(size);
    for (std::size_t i = 0; i < size; ++i)
        bytes[i] = static_cast<std::uint8_t>(i * 7 + static_cast<std::size_t>(seed));
    return bytes;
}

std::vector<fs::path> filesIn(const std::string& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().extension() == ".block")
            files.push_back(entry.path());
    return files;
}

} // namespace

TEST_CASE("blocks are found again, also by the next server") {
    TemporaryFolder folder;
    std::string path = folder.file("blocks");
    {
        auto blocks = opened(path);
        CHECK_FALSE(blocks->find("a").has_value());
        blocks->keep("a", block(1));
        blocks->keep("b", {});
        CHECK(blocks->find("a") == block(1));
        CHECK(blocks->find("b") == Bytes());
        CHECK(blocks->counts().hits == 2);
        CHECK(blocks->counts().misses == 1);
    }
    auto blocks = opened(path);
    CHECK(blocks->find("a") == block(1));
    CHECK_FALSE(blocks->find("A").has_value());
    blocks->keep("a", block(2)); // replaces it
    CHECK(blocks->find("a") == block(2));
    CHECK(filesIn(path).size() == 2);
    struct stat status {};
    REQUIRE(::stat(path.c_str(), &status) == 0);
    CHECK((status.st_mode & 0077) == 0);
    REQUIRE(::stat(filesIn(path)[0].c_str(), &status) == 0);
    CHECK((status.st_mode & 0077) == 0);
}

TEST_CASE("a block that is damaged anywhere, cut or another's is dropped and counted") {
    TemporaryFolder folder;
    std::string path = folder.file("blocks");
    auto blocks = opened(path);
    blocks->keep("key", block(1, 100));
    fs::path file = filesIn(path).at(0);
    std::string whole;
    {
        std::ifstream from(file, std::ios::binary);
        whole.assign(std::istreambuf_iterator<char>(from), {});
    }
    std::uint64_t damaged = 0;
    auto checkDropped = [&](const std::string& bytes) {
        std::ofstream(file, std::ios::binary) << bytes;
        CHECK_FALSE(blocks->find("key").has_value());
        CHECK(blocks->damaged() == ++damaged);
        CHECK_FALSE(fs::exists(file));
        CHECK(blocks->counts().bytes == 0);
        blocks->keep("key", block(1, 100));
        CHECK(blocks->find("key") == block(1, 100));
    };
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string bytes = whole;
        bytes[i] ^= 0x40;
        checkDropped(bytes);
        checkDropped(whole.substr(0, i));
    }
    checkDropped(whole + "x");
    fs::remove(file); // gone is not damaged
    CHECK_FALSE(blocks->find("key").has_value());
    CHECK(blocks->damaged() == damaged);
    // The file of another key under this one's name.
    blocks->keep("other", block(3, 100));
    fs::path other = filesIn(path).at(0);
    blocks->keep("key", block(1, 100));
    fs::copy_file(other, file, fs::copy_options::overwrite_existing);
    CHECK_FALSE(blocks->find("key").has_value());
    CHECK(blocks->damaged() == damaged + 1);
}

TEST_CASE("the bytes on disk are bounded, the least recently used leave first, also over restarts") {
    TemporaryFolder folder;
    std::string path = folder.file("blocks");
    auto bytesOnDisk = [&] {
        std::uint64_t bytes = 0;
        for (const fs::path& file : filesIn(path))
            bytes += fs::file_size(file);
        return bytes;
    };
    auto blocks = opened(path, 10'500);
    for (int i = 0; i < 20; ++i) {
        blocks->keep(cat("k", i), block(i));
        CHECK(blocks->find("k0") == block(0)); // used all the time
        CHECK(bytesOnDisk() <= 10'500);
        CHECK(bytesOnDisk() == blocks->counts().bytes);
        std::this_thread::sleep_for(std::chrono::milliseconds(5)); // ticks of the file system's clock
    }
    CHECK(blocks->counts().evicted == 10);
    CHECK(blocks->find("k19").has_value());
    CHECK_FALSE(blocks->find("k5").has_value());
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    CHECK(blocks->find("k0").has_value());
    blocks.reset();
    auto fewer = opened(path, 2'100); // two of them
    CHECK(fewer->find("k0").has_value());
    CHECK(fewer->find("k19").has_value());
    CHECK(filesIn(path).size() == 2);
    fewer->keep("large", block(1, 3000));
    CHECK(filesIn(path).size() == 2);
}

TEST_CASE("only a folder of its own is taken, by one server at a time, and what a killed one left goes") {
    TemporaryFolder folder;
    std::string path = folder.file("blocks");
    auto blocks = opened(path);
    blocks->keep("a", block(1));
    auto second = DiskBlocks::open(path, plenty);
    REQUIRE_FALSE(second.ok());
    CHECK(second.error().what == "another server uses the folder");
    std::string unfinished = filesIn(path)[0].string() + ".7.new";
    std::ofstream(unfinished) << "half";
    blocks.reset();
    blocks = opened(path);
    CHECK_FALSE(fs::exists(unfinished));
    CHECK(blocks->find("a") == block(1));
    blocks.reset();

    std::ofstream(path + "/holiday.jpg") << "x";
    auto refused = DiskBlocks::open(path, plenty);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().what.find("holiday.jpg") != std::string::npos);
    CHECK(DiskBlocks::open(folder.file("no/such/place"), plenty).error().code == ErrorCode::writeFailed);
}

TEST_CASE("what the disk refuses is counted and done without") {
    TemporaryFolder folder;
    std::string path = folder.file("blocks");
    auto blocks = opened(path);
    blocks->keep("a", block(1));
    fs::path place = filesIn(path)[0].parent_path();
    fs::remove_all(place);
    std::ofstream(place.string()) << "a file in the way";
    blocks->keep("a", block(1));
    CHECK(blocks->failures() == 1);
    CHECK_FALSE(blocks->find("a").has_value());
}

TEST_CASE("many threads keep and find blocks at once") {
    TemporaryFolder folder;
    auto blocks = opened(folder.file("blocks"), 20'000);
    std::vector<std::thread> threads;
    std::atomic<int> wrong{0};
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            for (int i = 0; i < 200; ++i) {
                int k = (i * (t + 1)) % 30;
                if (auto found = blocks->find(cat(k)); found && *found != block(k))
                    ++wrong;
                else if (!found)
                    blocks->keep(cat(k), block(k));
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    CHECK(wrong == 0);
    CHECK(blocks->counts().bytes <= 20'000);
    CHECK(blocks->damaged() == 0);
}
