// The verb `render` as a program would call it: options in, exit code and files out.
#include "client/headless/png.hpp"
#include "shared/cli/verb.hpp"
#include "shared/io/file_source.hpp"
#include "tests/golden/scene.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace stipple {
void addRenderVerb(CLI::App& program, cli::Action& action);
}

using namespace stipple;
namespace fs = std::filesystem;

namespace {

// A folder that goes with the test.
struct Scratch {
    fs::path path;
    Scratch() {
        std::string name = (fs::temp_directory_path() / "stipple_render_XXXXXX").string();
        path = mkdtemp(name.data());
    }
    ~Scratch() { fs::remove_all(path); }
    std::string file(const std::string& name) const { return (path / name).string(); }
    std::ptrdiff_t count() const { return std::distance(fs::directory_iterator(path), {}); }
};

// A cloud of several nodes, made once.
const std::string& cloudFile() {
    static Scratch folder;
    static std::string path = [] {
        auto made = golden::makeCloud({{"kind", "waves"}, {"points", 120000}}, folder.path.string());
        REQUIRE(made.ok());
        return *made;
    }();
    return path;
}

std::string bytesOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return std::string((std::istreambuf_iterator<char>(file)), {});
}

int render(std::vector<std::string> words) {
    CLI::App program;
    cli::Action action;
    addRenderVerb(program, action);
    words.insert(words.begin(), "render");
    std::reverse(words.begin(), words.end()); // CLI11 takes them from the back
    try {
        program.parse(words);
    } catch (const CLI::ParseError&) {
        return cli::usageError;
    }
    return action();
}

} // namespace

TEST_CASE("render says which point is at a place of the picture", "[render]") {
    Scratch scratch;
    CHECK(render({cloudFile(), "--pick", "640,360"}) == cli::success);
    CHECK(render({cloudFile(), "--pick", "2,2", "--size", "100x100"}) == cli::success); // nothing there
    for (const char* place : {"", "640", "640,", "a,b", "1,2,3", "nan,2", "1,inf"})
        CHECK(render({cloudFile(), "--pick", place}) == cli::usageError);
    CHECK(render({cloudFile(), "--pick", "1,2", "-o", scratch.file("a.png")}) == cli::usageError);
    CHECK(scratch.count() == 0);
}

TEST_CASE("render writes pictures larger than can be drawn at once", "[render]") {
    Scratch scratch;
    std::string output = scratch.file("a.png");
    for (const char* backend : {"software", "gles"}) {
        REQUIRE(render({cloudFile(), "-o", output, "--size", "17000x23", "--view", "top", "--backend",
                        backend, "--budget", "50000"}) == cli::success);
        auto image = headless::readPng(output);
        REQUIRE(image.ok());
        CHECK(image->width == 17000);
        CHECK(image->height == 23);
    }
    CHECK(render({cloudFile(), "-o", output, "--size", "65001x10"}) == cli::usageError);
}

TEST_CASE("render writes a picture of the size that was asked for", "[render]") {
    Scratch scratch;
    std::string output = scratch.file("a.png");
    REQUIRE(render({cloudFile(), "-o", output, "--size", "123x77", "--json"}) == cli::success);
    auto image = headless::readPng(output);
    REQUIRE(image.ok());
    CHECK(image->width == 123);
    CHECK(image->height == 77);
    CHECK(scratch.count() == 1);
    // Again, over the old picture: the same bytes.
    std::string before = bytesOf(output);
    REQUIRE(render({cloudFile(), "-o", output, "--size", "123x77", "--threads", "3"}) == cli::success);
    CHECK(bytesOf(output) == before);
}

TEST_CASE("the budget bounds the points, and a wider one shows more", "[render]") {
    headless::PictureRequest request;
    request.width = 200;
    request.height = 200;
    request.limits.minNodePixels = 1;
    auto pointsWith = [&](std::uint64_t budget) {
        request.limits.pointBudget = budget;
        auto source = openFileSource(cloudFile());
        REQUIRE(source.ok());
        auto picture = headless::drawPicture(*std::move(source), request);
        REQUIRE(picture.ok());
        CHECK(picture->frame.complete);
        return picture->frame.pointsDrawn;
    };
    auto few = pointsWith(60'000), all = pointsWith(10'000'000);
    CHECK(few <= 60'000);
    CHECK(few < all);
    CHECK(all == 120'000);
}

TEST_CASE("the first picture takes one request of 64 KiB", "[render]") {
    headless::PictureRequest request;
    request.limits.pointBudget = 1000; // within the root's first stratum
    auto source = openFileSource(cloudFile());
    REQUIRE(source.ok());
    auto picture = headless::drawPicture(*std::move(source), request);
    REQUIRE(picture.ok());
    CHECK(picture->frame.pointsDrawn == 1000);
    CHECK(picture->session.requests == 1);
    CHECK(picture->session.bytesReceived == 64 * 1024);
}

TEST_CASE("a picture can be drawn as soon as there is anything to see", "[render]") {
    headless::PictureRequest request;
    request.until = headless::Until::first;
    auto source = openFileSource(cloudFile());
    REQUIRE(source.ok());
    auto picture = headless::drawPicture(*std::move(source), request);
    REQUIRE(picture.ok());
    CHECK(picture->frame.pointsDrawn > 0);
    CHECK(picture->frame.nodesDrawn <= picture->frame.nodesSelected);
}

TEST_CASE("wrong options are told apart before anything is read", "[render]") {
    Scratch scratch;
    std::string output = scratch.file("a.png");
    std::vector<std::vector<std::string>> wrong{
        {"--view", "back"},
        {"--view", "{\"position\": [1, 2]}"},
        {"--view", "{\"place\": [1, 2, 3]}"},
        {"--view", "{\"position\""},
        {"--size", "100"},
        {"--size", "100x"},
        {"--size", "0x100"},
        {"--size", "100x99999"},
        {"--size", "100x100x100"},
        {"--style", "{\"colourMode\": \"rainbow\"}"},
        {"--style", "[]"},
        {"--backend", "vulkan"},
        {"--projection", "fisheye"},
        {"--budget", "0"},
        {"--threads", "-1"},
        {"--timeout", "0"},
    };
    for (auto words : wrong) {
        INFO(words[0] << " " << words[1]);
        words.insert(words.end(), {"missing.stipple", "-o", output});
        CHECK(render(words) == cli::usageError);
    }
    CHECK(render({cloudFile()}) == cli::usageError); // no output
    CHECK(scratch.count() == 0);
}

TEST_CASE("missing and foreign files and unwritable outputs have exit codes of their own", "[render]") {
    Scratch scratch;
    std::string output = scratch.file("a.png");
    CHECK(render({scratch.file("none.stipple"), "-o", output}) == cli::inputError);
    std::ofstream(scratch.file("text.stipple"))
        << "no cloud at all, but long enough to look at: " << std::string(500, 'x');
    CHECK(render({scratch.file("text.stipple"), "-o", output}) == cli::inputError);
    CHECK(render({cloudFile(), "-o", scratch.file("none/a.png")}) == cli::outputError);
    CHECK(render({"http://127.0.0.1:9/a.stipple", "-o", output, "--timeout", "1"}) == cli::networkError);
    CHECK(scratch.count() == 1); // the text alone
}

TEST_CASE("a picture says what its style asks for that the cloud has not", "[render]") {
    auto limitationsOf = [](const std::string& cloud, const Style& style) {
        auto source = openFileSource(cloud);
        REQUIRE(source.ok());
        headless::PictureRequest request;
        request.width = request.height = 64;
        request.style = style;
        auto picture = headless::drawPicture(std::move(*source), request);
        REQUIRE(picture.ok());
        return picture->limitations;
    };
    Style style;
    CHECK(limitationsOf(cloudFile(), style).empty());
    style.shape = PointShape::disc;
    auto said = limitationsOf(cloudFile(), style);
    REQUIRE(said.size() == 1);
    CHECK(said[0].find(cloudFile() + " has no normals") == 0);
    Scratch scratch;
    auto oriented = golden::makeCloud(
        {{"kind", "synth"}, {"scene", "town"}, {"points", 5000}, {"normals", true}}, scratch.path.string());
    REQUIRE(oriented.ok());
    CHECK(limitationsOf(*oriented, style).empty());
    CHECK(render({cloudFile(), "-o", scratch.file("a.png"), "--style", R"({"shape": "disc"})"}) ==
          cli::success);
}

TEST_CASE("a damaged cloud leaves an error and no picture", "[render]") {
    Scratch scratch;
    std::string whole = bytesOf(cloudFile()), damaged = scratch.file("damaged.stipple");
    std::string output = scratch.file("a.png");
    auto renderBytes = [&](const std::string& bytes) {
        std::ofstream(damaged, std::ios::binary) << bytes;
        return render({damaged, "-o", output, "--size", "64x64", "--timeout", "5"});
    };
    REQUIRE(renderBytes(whole) == cli::success);
    fs::remove(output);
    for (std::size_t size : {whole.size() - 1, whole.size() / 2, std::size_t{70000}, std::size_t{1000},
                             std::size_t{63}, std::size_t{0}}) {
        INFO("cut after " << size << " of " << whole.size());
        CHECK(renderBytes(whole.substr(0, size)) == cli::inputError);
        CHECK(scratch.count() == 1);
    }
    // Any byte of the blocks a picture needs is covered by a checksum; further attributes are not read.
    int failed = 0;
    for (std::size_t at = 0; at < whole.size(); at += whole.size() / 40) {
        std::string bytes = whole;
        bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
        INFO("byte " << at);
        int code = renderBytes(bytes);
        CHECK((code == cli::success || code == cli::inputError));
        CHECK(fs::exists(output) == (code == cli::success));
        fs::remove(output);
        failed += code != cli::success;
    }
    CHECK(failed > 5);
}
