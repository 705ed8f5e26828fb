#include "converter/synth/synthesize.hpp"
#include "shared/io/file_source.hpp"
#include "shared/las/las_reader.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

using namespace stipple;
using namespace stipple::synth;

namespace {

struct Folder {
    Folder()
        : path(std::filesystem::temp_directory_path() / ("stipple-synth-" + std::to_string(std::rand()))) {
        std::filesystem::create_directories(path);
    }
    ~Folder() { std::filesystem::remove_all(path); }
    std::string file(const std::string& name) const { return (path / name).string(); }
    std::filesystem::path path;
};

std::string contents(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string fileOf(const Folder& folder, SynthOptions options, const std::string& name) {
    auto report = synthesize(folder.file(name), options, {});
    REQUIRE(report.ok());
    REQUIRE(report->points == options.points);
    return contents(folder.file(name));
}

} // namespace

TEST_CASE("the same seed gives the same bytes on one, two and five threads; another seed others") {
    Folder folder;
    for (SceneKind kind : {SceneKind::town, SceneKind::indoor, SceneKind::terrain}) {
        SynthOptions options;
        options.scene = kind;
        options.points = 120'000;
        options.seed = 11;
        std::string one = fileOf(folder, options, "1.las");
        options.threads = 2;
        CHECK((fileOf(folder, options, "2.las") == one));
        options.threads = 5;
        CHECK((fileOf(folder, options, "5.las") == one));
        options.seed = 12;
        CHECK((fileOf(folder, options, "other.las") != one));
    }
}

TEST_CASE("the file holds exactly the points asked for, down to none") {
    Folder folder;
    for (std::uint64_t points : {0u, 1u, 2u, 17u, 1000u, 12'345u}) {
        SynthOptions options;
        options.points = points;
        options.scene = points % 2 == 0 ? SceneKind::town : SceneKind::terrain;
        fileOf(folder, options, "n.las");
        auto source = openFileSource(folder.file("n.las"));
        REQUIRE(source.ok());
        auto reader = las::Reader::open(**source);
        REQUIRE(reader.ok());
        CHECK((*reader)->pointCount() == points);
        CHECK((*reader)->header().pointCount == points);
        CHECK((*reader)->warnings().empty());
    }
}

TEST_CASE("the header says what the points are: LAS 1.4, format 7, UTM, bounds that hold exactly") {
    Folder folder;
    SynthOptions options;
    options.points = 30'000;
    fileOf(folder, options, "town.las");
    auto source = openFileSource(folder.file("town.las"));
    REQUIRE(source.ok());
    auto opened = las::Reader::open(**source);
    REQUIRE(opened.ok());
    las::Reader& reader = **opened;
    const las::Header& header = reader.header();
    CHECK(header.versionMinor == 4);
    CHECK(header.pointFormat == 7);
    CHECK((header.globalEncoding & 1) == 1);   // adjusted standard GPS time
    CHECK((header.globalEncoding & 16) == 16); // WKT
    bool wkt = false;
    for (const las::Vlr& vlr : header.vlrs)
        wkt = wkt || std::string(vlr.data.begin(), vlr.data.end()).find("UTM zone 32N") != std::string::npos;
    CHECK(wkt);
    PointBatch batch;
    REQUIRE(reader.read(0, reader.pointCount(), batch).ok());
    BoxD box;
    for (Vec3i p : batch.positions)
        box.extend(header.grid.toWorld(p));
    for (int axis = 0; axis < 3; ++axis) {
        CHECK(header.bounds.min[axis] == Approx(box.min[axis]).margin(1e-6));
        CHECK(header.bounds.max[axis] == Approx(box.max[axis]).margin(1e-6));
    }
    CHECK(box.min.x > 499'700);
    CHECK(box.max.y < 5'400'300);
}

TEST_CASE("an output that can't be written is an error, and nothing is left") {
    SynthOptions options;
    options.points = 10;
    auto report = synthesize("/nonexistent-folder/town.las", options, {});
    REQUIRE_FALSE(report.ok());
    CHECK_FALSE(report.error().sentence().empty());
}
