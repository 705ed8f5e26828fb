#include "client/headless/png.hpp"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

using namespace stipple;
using namespace stipple::headless;
namespace fs = std::filesystem;

namespace {

// A folder that goes with the test.
struct Scratch {
    fs::path path;
    Scratch() {
        std::string name = (fs::temp_directory_path() / "stipple_png_XXXXXX").string();
        path = mkdtemp(name.data());
    }
    ~Scratch() { fs::remove_all(path); }
    std::string file(const char* name) const { return (path / name).string(); }
};

Image sample() {
    Image image{5, 3, {}};
    for (std::size_t i = 0; i < 15; ++i)
        for (std::size_t c = 0; c < 4; ++c)
            image.rgba.push_back(c == 3 ? std::uint8_t{255} : static_cast<std::uint8_t>(i * 16 + c));
    return image;
}

} // namespace

TEST_CASE("a picture written as PNG is read back equal", "[png]") {
    Scratch scratch;
    REQUIRE(writePng(scratch.file("a.png"), sample()).ok());
    auto read = readPng(scratch.file("a.png"));
    REQUIRE(read.ok());
    CHECK(read->width == 5);
    CHECK(read->height == 3);
    CHECK(read->rgba == sample().rgba);
    CHECK(std::distance(fs::directory_iterator(scratch.path), {}) == 1); // no temporary file stays
}

TEST_CASE("a PNG into a folder that does not exist is refused", "[png]") {
    Scratch scratch;
    Status status = writePng(scratch.file("missing/a.png"), sample());
    REQUIRE_FALSE(status.ok());
    CHECK(status.error().code == ErrorCode::writeFailed);
}

TEST_CASE("missing, foreign and cut PNG files are told apart", "[png]") {
    Scratch scratch;
    CHECK(readPng(scratch.file("none.png")).error().code == ErrorCode::notFound);

    REQUIRE(writePng(scratch.file("a.png"), sample()).ok());
    std::ifstream whole(scratch.file("a.png"), std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(whole)), {});
    // The last chunk, IEND, takes 12 bytes and carries no pixels.
    for (std::size_t size = 0; size + 12 < bytes.size(); ++size) {
        std::ofstream(scratch.file("cut.png"), std::ios::binary) << bytes.substr(0, size);
        auto read = readPng(scratch.file("cut.png"));
        INFO("cut after " << size << " of " << bytes.size());
        REQUIRE_FALSE(read.ok());
        CHECK(read.error().code == ErrorCode::corrupt);
    }
}
