#include "client/headless/range_store.hpp"

#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <random>

using namespace stipple;
using namespace stipple::test;
namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t plenty = 64 << 20;
const std::string url = "http://host/a.stipple";

FileVersion versionOf(const std::string& etag = "\"1\"", std::uint64_t size = 1'000'000) {
    return {etag, "", size, true};
}

std::shared_ptr<RangeStore> opened(const std::string& folder, std::uint64_t most = plenty) {
    auto store = RangeStore::open(folder, most);
    REQUIRE(store.ok());
    return *store;
}

Bytes fileBytes(std::uint64_t offset, std::uint64_t size) {
    Bytes bytes(static_cast<std::size_t>(size));
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::uint8_t>((offset + i) * 7 + (offset + i) / 251);
    return bytes;
}

std::uint64_t head(StoredRanges& stored, ByteRange range) {
    Bytes bytes;
    std::uint64_t size = stored.readHead(range, bytes);
    CHECK(bytes == fileBytes(range.offset, size));
    return size;
}

std::string fileOf(const std::string& folder, const std::string& suffix) {
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == suffix)
            return entry.path().string();
    FAIL("no such file");
    return {};
}

} // namespace

TEST_CASE("ranges are found again, over pieces, also by the next program") {
    TemporaryFolder folder;
    {
        auto stored = opened(folder.path())->version(url, versionOf());
        REQUIRE(stored);
        stored->keep(1000, fileBytes(1000, 200'000)); // four pieces
        stored->keep(201'000, fileBytes(201'000, 10));
        stored->keep(500, fileBytes(500, 2000)); // half of it is here
        CHECK(head(*stored, {500, 400'000}) == 200'510);
        CHECK(head(*stored, {100'000, 7}) == 7);
        CHECK(head(*stored, {499, 7}) == 0);
        CHECK(head(*stored, {201'010, 7}) == 0);
    }
    auto stored = opened(folder.path())->version(url, versionOf());
    REQUIRE(stored);
    CHECK(head(*stored, {500, 400'000}) == 200'510);
    Bytes tail{1, 2};
    CHECK(stored->readTail({100, 150'000}, tail) == 149'600);
    Bytes expected = fileBytes(500, 149'600);
    expected.push_back(1);
    expected.push_back(2);
    CHECK(tail == expected);
}

TEST_CASE("whatever is kept in whatever order, what is found is the file's") {
    TemporaryFolder folder;
    auto stored = opened(folder.path())->version(url, versionOf());
    std::mt19937 random(5);
    std::vector<bool> here(400'000);
    for (int i = 0; i < 60; ++i) {
        std::uint64_t offset = random() % 300'000, size = random() % 100'000;
        stored->keep(offset, fileBytes(offset, size));
        std::fill(here.begin() + static_cast<std::ptrdiff_t>(offset),
                  here.begin() + static_cast<std::ptrdiff_t>(offset + size), true);
        ByteRange asked{random() % 300'000, random() % 100'000};
        std::uint64_t expected = 0;
        while (expected < asked.size && here[asked.offset + expected])
            ++expected;
        CHECK(head(*stored, asked) == expected);
    }
}

TEST_CASE("another address, version or size is another file; weak tags are not kept") {
    TemporaryFolder folder;
    auto store = opened(folder.path());
    store->version(url, versionOf())->keep(0, fileBytes(0, 100));
    CHECK(head(*store->version(url, versionOf()), {0, 100}) == 100);
    CHECK(head(*store->version(url, versionOf("\"2\"")), {0, 100}) == 0);
    CHECK(head(*store->version(url, versionOf("\"1\"", 999)), {0, 100}) == 0);
    CHECK(head(*store->version(url + "b", versionOf()), {0, 100}) == 0);
    CHECK_FALSE(store->version(url, versionOf("W/\"1\"")));
    CHECK_FALSE(store->version(url, versionOf("")));
}

TEST_CASE("a version is used by one at a time") {
    TemporaryFolder folder;
    auto store = opened(folder.path()), other = opened(folder.path());
    auto stored = store->version(url, versionOf());
    CHECK(stored);
    CHECK_FALSE(other->version(url, versionOf()));
    stored.reset();
    CHECK(other->version(url, versionOf()));
}

TEST_CASE("damage in any byte of the files costs what it hits, and never gives wrong bytes") {
    TemporaryFolder folder;
    {
        auto stored = opened(folder.path())->version(url, versionOf());
        for (std::uint64_t i = 0; i < 6; ++i)
            stored->keep(i * 1000, fileBytes(i * 1000, 500));
    }
    for (const char* suffix : {".bytes", ".ranges"}) {
        std::string path = fileOf(folder.path(), suffix);
        std::ifstream stream(path, std::ios::binary);
        std::string whole(std::istreambuf_iterator<char>(stream), {});
        for (std::size_t at = 0; at < whole.size(); at += suffix[1] == 'b' ? 61 : 1) {
            std::string damaged = whole;
            damaged[at] = static_cast<char>(damaged[at] ^ 0x41);
            std::ofstream(path, std::ios::binary) << damaged;
            auto stored = opened(folder.path())->version(url, versionOf());
            REQUIRE(stored);
            for (std::uint64_t i = 0; i < 6; ++i)
                head(*stored, {i * 1000, 500}); // checks the bytes
            stored->keep(2000, fileBytes(2000, 500));
            CHECK(head(*stored, {2000, 500}) == 500);
        }
        for (std::size_t size = 0; size < whole.size(); size += 7) { // cut off
            std::ofstream(path, std::ios::binary) << whole.substr(0, size);
            auto stored = opened(folder.path())->version(url, versionOf());
            REQUIRE(stored);
            for (std::uint64_t i = 0; i < 6; ++i)
                head(*stored, {i * 1000, 500});
        }
        std::ofstream(path, std::ios::binary) << whole;
    }
}

TEST_CASE("the folder stays within its bytes, the oldest versions go, and other files stay") {
    TemporaryFolder folder;
    std::ofstream(folder.file("mine.txt")) << "mine";
    for (int i = 0; i < 8; ++i) {
        auto store = opened(folder.path(), 1 << 20);
        auto stored = store->version(url + std::to_string(i), versionOf());
        REQUIRE(stored);
        stored->keep(0, fileBytes(0, 400'000));
        std::uint64_t bytes = 0;
        for (const auto& entry : fs::directory_iterator(folder.path()))
            bytes += entry.file_size();
        CHECK(bytes <= (1 << 20) + 100'000); // rounded up to blocks of the disk
    }
    CHECK(head(*opened(folder.path())->version(url + "7", versionOf()), {0, 1000}) == 1000);
    CHECK(head(*opened(folder.path())->version(url + "0", versionOf()), {0, 1000}) == 0);
    CHECK(fs::exists(folder.file("mine.txt")));
}

TEST_CASE("a folder that can't be used is refused") {
    TemporaryFolder folder;
    std::ofstream(folder.file("file")) << "x";
    CHECK(RangeStore::open(folder.file("file"), plenty).error().code == ErrorCode::writeFailed);
    CHECK(RangeStore::open(folder.file("no/such"), plenty).error().code == ErrorCode::writeFailed);
}
