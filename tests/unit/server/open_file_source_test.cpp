#include "server/files/open_file_source.hpp"

#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <fstream>

namespace stipple::server {
namespace {

void put(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
}

std::string textOf(const Result<Bytes>& bytes) {
    return bytes ? std::string(bytes->begin(), bytes->end()) : bytes.error().sentence();
}

TEST_CASE("a source over an open file reads ranges of it, cut at its end") {
    test::TemporaryFolder folder;
    put(folder.file("a"), "0123456789");
    auto file = OpenFile::open(folder.file("a"));
    REQUIRE(file);
    auto source = sourceOver(*file, "a");
    CHECK(source->sizeBytes() == 10);
    CHECK(source->name() == "a");
    CHECK(textOf(readNow(*source, {2, 3})) == "234");
    CHECK(textOf(readNow(*source, {8, 100})) == "89");
    CHECK(textOf(readNow(*source, {10, 0})).empty());
    auto past = readNow(*source, {10, 1});
    REQUIRE_FALSE(past);
    CHECK(past.error().code == ErrorCode::truncated);
}

TEST_CASE("a source over an open file that was written to says so instead of mixing versions") {
    test::TemporaryFolder folder;
    put(folder.file("a"), "0123456789");
    auto file = OpenFile::open(folder.file("a"));
    REQUIRE(file);
    auto source = sourceOver(*file, "a");
    put(folder.file("a"), "01234");
    for (ByteRange range : {ByteRange{0, 2}, ByteRange{7, 2}}) {
        auto bytes = readNow(*source, range);
        REQUIRE_FALSE(bytes);
        CHECK(bytes.error().code == ErrorCode::changed);
    }
}

TEST_CASE("a source over an open file goes on with the version it has when the name goes to another file") {
    test::TemporaryFolder folder;
    put(folder.file("a"), "0123456789");
    put(folder.file("b"), "abcdefghij");
    auto file = OpenFile::open(folder.file("a"));
    REQUIRE(file);
    auto source = sourceOver(*file, "a");
    REQUIRE(std::rename(folder.file("b").c_str(), folder.file("a").c_str()) == 0);
    CHECK(textOf(readNow(*source, {0, 4})) == "0123");
}

} // namespace
} // namespace stipple::server
