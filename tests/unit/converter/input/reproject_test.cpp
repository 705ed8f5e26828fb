// Inputs brought into another coordinate reference system.
#include "converter/input/reproject.hpp"

#include "converter/crs/crs.hpp"
#include "converter/input/las_input.hpp"
#include "shared/las/las_writer.hpp"
#include "tests/support/temporary_folder.hpp"

#include <cmath>

using namespace stipple;
using namespace stipple::test;

namespace {
constexpr double pi = 3.14159265358979323846, radius = 6378137;

struct Scan {
    Grid grid;
    std::vector<Vec3i> positions;
};

// Point format 0; Intensity is the point's index.
std::string written(const TemporaryFolder& folder, const Scan& scan, const std::string& crs) {
    las::WriterOptions options;
    options.grid = scan.grid;
    options.schema = las::schemaOf(0);
    options.pointFormat = 0;
    if (!crs.empty())
        options.wkt = crsFromUser(crs)->wkt;
    std::string path = folder.file("in.las");
    auto writer = las::Writer::create(path, options);
    REQUIRE(writer.ok());
    PointBatch points;
    points.resize(options.schema, scan.positions.size());
    points.positions = scan.positions;
    int intensity = options.schema.find(attribute_names::intensity);
    for (std::size_t i = 0; i < points.size(); ++i)
        points.setValue<std::uint16_t>(intensity, i, static_cast<std::uint16_t>(i));
    REQUIRE((*writer)->write(points).ok());
    REQUIRE((*writer)->finish().ok());
    return path;
}

std::unique_ptr<PointInput> reprojected(const std::string& path, const std::string& crs) {
    auto input = openLasInput(path);
    REQUIRE(input.ok());
    Crs to = *crsFromUser(crs);
    auto transformation = CrsTransformation::create((*input)->description().crs, to, {});
    if (!transformation)
        FAIL(transformation.error().sentence());
    auto result = reprojectInput(std::move(*input), *transformation, to);
    if (!result)
        FAIL(result.error().sentence());
    return std::move(*result);
}

struct Points {
    std::vector<Vec3d> world;
    std::vector<std::uint16_t> intensity;
    BoxI bounds;
    ReadReport report;
};
Points readAll(const PointInput& input) {
    Points points;
    const InputDescription& d = input.description();
    int intensity = d.schema.find(attribute_names::intensity);
    for (std::size_t part = 0; part < input.parts().size(); ++part) {
        auto stream = input.openPart(part);
        REQUIRE(stream.ok());
        PointBatch batch;
        do {
            REQUIRE((*stream)->next(batch).ok());
            for (std::size_t i = 0; i < batch.size(); ++i) {
                points.bounds.extend(batch.positions[i]);
                points.world.push_back(d.grid.toWorld(batch.positions[i]));
                points.intensity.push_back(batch.value<std::uint16_t>(intensity, i));
            }
        } while (batch.size() > 0);
        points.report.add((*stream)->report());
    }
    return points;
}

Vec3d mercator(Vec3d degrees) {
    return {radius * degrees.x * pi / 180, radius * std::log(std::tan(pi / 4 + degrees.y * pi / 360)),
            degrees.z};
}

// A strip of 300 points in Bavaria, millimetres apart at the least.
Scan bavaria() {
    Scan scan{{{1e-7, 1e-7, 0.001}, {11, 48, 0}}, {}};
    for (int i = 0; i < 300; ++i)
        scan.positions.push_back({i * 10007, i * 3001 - 500000, 500000 + i});
    return scan;
}
} // namespace

TEST_CASE("points come to where the formula says, to half a step; z and attributes stay", "[reproject]") {
    TemporaryFolder folder;
    Scan scan = bavaria();
    auto input = reprojected(written(folder, scan, "EPSG:4326"), "EPSG:3857");
    const InputDescription& d = input->description();
    CHECK(d.crs.epsg == 3857);
    CHECK(d.grid.scale == Vec3d{0.01, 0.01, 0.001}); // 1e-7 degrees are 11 mm
    CHECK(d.grid.offset.z == 0);
    CHECK_FALSE(d.boundsAreMeasured);
    CHECK(d.source.format.find("reprojected from WGS 84 (EPSG:4326)") != std::string::npos);
    Points points = readAll(*input);
    REQUIRE(points.world.size() == scan.positions.size());
    double furthest = 0;
    for (std::size_t i = 0; i < scan.positions.size(); ++i) {
        Vec3d exact = mercator(scan.grid.toWorld(scan.positions[i]));
        furthest = std::max(
            {furthest, std::abs(points.world[i].x - exact.x), std::abs(points.world[i].y - exact.y)});
        CHECK(points.world[i].z == scan.grid.toWorld(scan.positions[i]).z);
        CHECK(points.intensity[i] == i);
    }
    CHECK(furthest <= 0.005 + 1e-8);
    CHECK(points.report.maxRounding == Approx(furthest).margin(1e-8));
    CHECK(points.report.dropped() == 0);
    CHECK(d.bounds.contains(points.bounds.min));
    CHECK(d.bounds.contains(points.bounds.max));
}

TEST_CASE("the grid is as fine as the input's, in the unit of the new system", "[reproject]") {
    TemporaryFolder folder;
    Scan meters{{{0.001, 0.001, 0.01}, {500000, 5300000, 0}}, {{0, 0, 0}, {1000000, 1000000, 1000}}};
    std::string path = written(folder, meters, "EPSG:32632");
    CHECK(reprojected(path, "EPSG:4326")->description().grid.scale == Vec3d{1e-9, 1e-9, 0.01});
    CHECK(reprojected(path, "EPSG:2992")->description().grid.scale == Vec3d{0.001, 0.001, 0.01});
    CHECK(reprojected(path, "EPSG:4978")->description().grid.scale == Vec3d{0.001, 0.001, 0.01});
    // So that LAS can count the points again.
    Grid grid = reprojected(path, "EPSG:25833")->description().grid;
    CHECK(grid.offset.y > 5e6);
}

TEST_CASE("there and back again is the same place", "[reproject]") {
    TemporaryFolder folder, second;
    Scan scan{{{0.001, 0.001, 0.001}, {500000, 4000000, 0}}, {}};
    for (int i = 0; i < 1000; ++i)
        scan.positions.push_back({i * 997, i * 1009, i});
    auto there = reprojected(written(folder, scan, "EPSG:32610"), "EPSG:4326");
    Scan degrees{there->description().grid, {}};
    PointBatch batch;
    auto stream = there->openPart(0);
    REQUIRE((*stream)->next(batch).ok());
    degrees.positions = batch.positions;
    Points back = readAll(*reprojected(written(second, degrees, "EPSG:4326"), "EPSG:32610"));
    for (std::size_t i = 0; i < scan.positions.size(); ++i) {
        Vec3d first = scan.grid.toWorld(scan.positions[i]);
        CHECK(std::abs(back.world[i].x - first.x) < 0.001);
        CHECK(std::abs(back.world[i].y - first.y) < 0.001);
        CHECK(back.world[i].z == first.z);
    }
}

TEST_CASE("points that can't be transformed are left out and counted; their neighbours stay whole",
          "[reproject]") {
    TemporaryFolder folder;
    Scan scan{{{1e-6, 1e-6, 0.001}, {0, 0, 0}}, {}};
    for (int i = 0; i < 70000; ++i) // more than a batch; the first batch has none that stays
        scan.positions.push_back(i < 66000 || i % 2 == 0 ? Vec3i{9000000, 95000000 + i, i}
                                                         : Vec3i{9000000, 48000000 + i, i});
    auto input = reprojected(written(folder, scan, "EPSG:4326"), "EPSG:32632");
    CHECK(input->description().source.pointCount == 70000);
    Points points = readAll(*input);
    CHECK(points.world.size() == 2000);
    CHECK(points.report.untransformable == 68000);
    CHECK(points.report.dropped() == 68000);
    for (std::size_t i = 0; i < points.world.size(); ++i) {
        CHECK(points.intensity[i] == static_cast<std::uint16_t>(66001 + 2 * i));
        CHECK(points.world[i].x == Approx(500000).margin(0.1));
        CHECK(points.world[i].z == Approx(0.001 * static_cast<double>(66001 + 2 * i)));
    }
}

TEST_CASE("an input without points is reprojected, too", "[reproject]") {
    TemporaryFolder folder;
    Scan scan{{{0.001, 0.001, 0.001}, {0, 0, 0}}, {}};
    auto input = reprojected(written(folder, scan, "EPSG:32610"), "EPSG:4326");
    CHECK(input->description().bounds.empty());
    CHECK(input->description().grid.scale == Vec3d{1e-9, 1e-9, 0.001});
    CHECK(readAll(*input).world.empty());
}

TEST_CASE("stated bounds that reach where nothing can be transformed do no harm", "[reproject]") {
    TemporaryFolder folder;
    Scan scan{{{1e-6, 1e-6, 0.001}, {0, 0, 0}}, {{9000000, 48000000, 0}, {2000000000, 2000000000, 0}}};
    auto input = reprojected(written(folder, scan, "EPSG:4326"), "EPSG:32632");
    Points points = readAll(*input);
    CHECK(points.world.size() + points.report.dropped() == 2);
    CHECK(points.world.at(0).x == Approx(500000).margin(0.01));
}
