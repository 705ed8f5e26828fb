// Byte sources over a buffer and over a file, and reading from one that answers later.
#include "shared/io/byte_source.hpp"
#include "shared/io/file_source.hpp"
#include "shared/io/memory_source.hpp"
#include "tests/support/temporary_folder.hpp"

#include <optional>

#ifndef __EMSCRIPTEN__
#include <sys/stat.h>
#endif

using namespace stipple;
using namespace stipple::test;

namespace {

std::string textOf(const Result<Bytes>& bytes) {
    REQUIRE(bytes.ok());
    return std::string(bytes->begin(), bytes->end());
}

// What any source over the ten bytes "0123456789" must answer.
void requireTenDigits(ByteSource& source) {
    CHECK(textOf(readNow(source, {0, 10})) == "0123456789");
    CHECK(textOf(readNow(source, {3, 4})) == "3456");
    CHECK(textOf(readNow(source, {8, 100})) == "89"); // cut at the end
    CHECK(textOf(readNow(source, {8, ~std::uint64_t{0}})) == "89");
    CHECK(textOf(readNow(source, {4, 0})) == "");
    CHECK(textOf(readNow(source, {10, 0})) == "");
    CHECK(readNow(source, {10, 1}).error().code == ErrorCode::truncated);
    CHECK(readNow(source, {11, 0}).error().code == ErrorCode::truncated);
    CHECK(readNow(source, {~std::uint64_t{0}, 1}).error().code == ErrorCode::truncated);
    CHECK(source.sizeBytes() == 10);
}

} // namespace

TEST_CASE("a buffer answers ranges") {
    MemorySource source(Bytes{'0', '1', '2', '3', '4', '5', '6', '7', '8', '9'}, "digits");
    requireTenDigits(source);
    CHECK(source.name() == "digits");
}

TEST_CASE("a file answers ranges") {
    TemporaryFolder folder;
    writeText(folder.file("digits"), "0123456789");
    auto source = openFileSource(folder.file("digits"));
    REQUIRE(source.ok());
    requireTenDigits(**source);
    CHECK((*source)->name() == folder.file("digits"));
}

TEST_CASE("a file that is not there, or is none, is told apart") {
    TemporaryFolder folder;
    auto absent = openFileSource(folder.file("absent"));
    REQUIRE(!absent.ok());
    CHECK(absent.error().code == ErrorCode::notFound);
    CHECK(absent.error().sentence().find(folder.file("absent")) == 0);
    CHECK(openFileSource(folder.path()).error().code == ErrorCode::invalidArgument);
}

#ifndef __EMSCRIPTEN__
TEST_CASE("a pipe is refused without waiting for a writer") {
    TemporaryFolder folder;
    REQUIRE(::mkfifo(folder.file("pipe").c_str(), 0600) == 0);
    CHECK(openFileSource(folder.file("pipe")).error().code == ErrorCode::invalidArgument);
}

TEST_CASE("a file that changes under its reader answers that it changed") {
    TemporaryFolder folder;
    writeText(folder.file("a"), "0123456789");
    auto source = openFileSource(folder.file("a"));
    REQUIRE(source.ok());
    CHECK(readNow(**source, {0, 4}).ok());
    writeText(folder.file("a"), "01234");
    CHECK(readNow(**source, {0, 4}).error().code == ErrorCode::changed);
}

TEST_CASE("a file that is replaced stays the version that was opened") {
    TemporaryFolder folder;
    writeText(folder.file("a"), "old");
    auto source = openFileSource(folder.file("a"));
    REQUIRE(source.ok());
    writeText(folder.file("b"), "new");
    std::filesystem::rename(folder.file("b"), folder.file("a"));
    CHECK(textOf(readNow(**source, {0, 3})) == "old");
}
#endif

TEST_CASE("readNow pumps a source until it answers") {
    // Answers at the third pump.
    class LateSource final : public ByteSource {
      public:
        RequestId read(ByteRange range, Completion done) override {
            range_ = range;
            done_ = std::move(done);
            return 1;
        }
        int pump(std::chrono::milliseconds) override {
            if (++pumps != 3)
                return 0;
            done_(Bytes(static_cast<std::size_t>(range_.size), 'x'));
            return 1;
        }
        std::uint64_t sizeBytes() const override { return 0; }
        std::string name() const override { return "late"; }
        int pumps = 0;

      private:
        ByteRange range_;
        Completion done_;
    };
    LateSource source;
    CHECK(textOf(readNow(source, {0, 2})) == "xx");
    CHECK(source.pumps == 3);
}
