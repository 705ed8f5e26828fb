#include "converter/export/geojson.hpp"
#include "shared/base/text.hpp"
#include "shared/io/memory_source.hpp"
#include "tests/unit/converter/export/export_fixture.hpp"

#include <cmath>
#include <limits>

using namespace stipple;
using namespace stipple::test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

TEST_CASE("a box takes the points a comparison of world coordinates takes, and no other node is read") {
    SmallCloudFile file(quarterGrid());
    for (BoxD box : {BoxD{{500000, 4000000, -infinity}, {500200, 4000100, infinity}},
                     BoxD{{499900.1, 3999900.3, 10.2}, {500100.7, 4000800.9, 600.1}},
                     BoxD{{-infinity, -infinity, -infinity}, {infinity, 4000000, infinity}}}) {
        PointFilter filter;
        filter.box = box;
        AllPoints all = allPoints(file.path);
        WalkCounters c =
            compareExport(file, filter, [&](std::size_t i) { return box.contains(all.world(i)); });
        CHECK(knownNodes(c) == file.cloud.nodes.size());
        CHECK(c.outside.nodes > 0);
        CHECK(c.tested.nodes > 0);
    }
}

TEST_CASE("sides of a box belong to it, to the last bit") {
    SmallCloudOptions options;
    options.levels = 2;
    options.grid = {{0.1, 0.01, 0.001}, {123456.789, -0.3, 1e-3}}; // none of it exact in double
    SmallCloudFile file(options);
    AllPoints all = allPoints(file.path);
    for (std::size_t pick : {std::size_t{0}, all.points.size() / 2, all.points.size() - 1}) {
        Vec3d at = all.world(pick);
        PointFilter filter;
        filter.box = BoxD{at, at};
        WalkCounters c = compareExport(file, filter, [&](std::size_t i) { return all.world(i) == at; });
        CHECK(c.pointsTaken >= 1);
        for (int axis = 0; axis < 3; ++axis) {
            PointFilter above = filter, below = filter;
            above.box->min[axis] = std::nextafter(at[axis], infinity);
            above.box->max[axis] = infinity;
            below.box->max[axis] = std::nextafter(at[axis], -infinity);
            below.box->min[axis] = -infinity;
            for (const PointFilter& half : {above, below})
                compareExport(file, half, [&](std::size_t i) { return half.box->contains(all.world(i)); });
        }
    }
}

TEST_CASE("a box in grid integers is taken as it is, with one in world units both hold") {
    SmallCloudFile file(quarterGrid());
    AllPoints all = allPoints(file.path);
    PointFilter filter;
    filter.gridBox = BoxI{{0, 0, 0}, {1000, 1500, 2000}};
    compareExport(file, filter,
                  [&](std::size_t i) { return filter.gridBox->contains(all.points.positions[i]); });
    filter.box = BoxD{{500100, 4000000, 0}, {500300, 4000200, 1000}};
    compareExport(file, filter, [&](std::size_t i) {
        return filter.gridBox->contains(all.points.positions[i]) && filter.box->contains(all.world(i));
    });
}

TEST_CASE("polygons with holes take the points a test of every point takes") {
    SmallCloudFile file(quarterGrid());
    AllPoints all = allPoints(file.path);
    // A star around the middle with a square hole, and a triangle apart; the star's corners are points.
    Vec3d corner = all.world(5), other = all.world(9);
    std::string json = cat(
        R"({"type": "MultiPolygon", "coordinates": [[[[500050,4000050],[500700,4000300],)", "[", corner.x,
        ",", std::to_string(corner.y), "],[500600,4000900],[", std::to_string(other.x), ",",
        std::to_string(other.y),
        R"(],[500050,4000050]], [[500400,4000400],[500450,4000400],[500450,4000450],[500400,4000450],[500400,4000400]]],
            [[[499930,3999960],[500030,3999960],[499930,4000060],[499930,3999960]]]]})");
    PointFilter filter;
    filter.region = need(parseGeoJson(json, "test")).region;
    WalkCounters c = compareExport(file, filter, [&](std::size_t i) {
        Vec3d world = all.world(i);
        return filter.region->contains({world.x, world.y});
    });
    CHECK(c.pointsTaken > 100);
    CHECK(c.outside.nodes > 0);
    CHECK(c.dropped.byRegion > 0);
    CHECK(knownNodes(c) == file.cloud.nodes.size());
    // A polygon and a box together.
    filter.box = BoxD{{500000, 4000000, 100}, {500400, 4000500, 600}};
    compareExport(file, filter, [&](std::size_t i) {
        Vec3d world = all.world(i);
        return filter.region->contains({world.x, world.y}) && filter.box->contains(world);
    });
}

TEST_CASE("nodes wholly inside a polygon are taken without a test, those in its holes not read") {
    SmallCloudFile file(quarterGrid());
    AllPoints all = allPoints(file.path);
    // All of the cloud but its lowest quarter, which is three levels of nodes.
    double x0 = 500000 - 75.125, y0 = 4000000 - 50.125, side = 512.25;
    auto ring = [](double x, double y, double w) {
        return Ring({{x, y}, {x + w, y}, {x + w, y + w}, {x, y + w}, {x, y}});
    };
    PointFilter filter;
    filter.region = std::make_shared<PolygonRegion>(
        std::vector<Polygon>{{ring(x0 - 10, y0 - 10, 2000), {ring(x0, y0, side)}}});
    WalkCounters c = compareExport(file, filter, [&](std::size_t i) {
        Vec3d p = all.world(i);
        return !(p.x > x0 && p.x < x0 + side && p.y > y0 && p.y < y0 + side);
    });
    CHECK(c.whole.nodes > 40);
    CHECK(c.outside.nodes >= 16);
    CHECK(c.tested.nodes < 25);
}

TEST_CASE("attribute conditions take the values in their ranges") {
    SmallCloudFile file(quarterGrid());
    AllPoints all = allPoints(file.path);
    int intensity = all.metadata.schema.find("Intensity"),
        source = all.metadata.schema.find("Point Source ID");
    PointFilter filter;
    filter.conditions = {{"Intensity", {{100, 20000}, {40000, 40000}, {50000, 1e9}}},
                         {"point source id", {{0, 30000}}}};
    WalkCounters c = compareExport(file, filter, [&](std::size_t i) {
        auto value = all.points.value<std::uint16_t>(intensity, i);
        bool in = (value >= 100 && value <= 20000) || value == 40000 || value >= 50000;
        return in && all.points.value<std::uint16_t>(source, i) <= 30000;
    });
    CHECK(c.dropped.byAttribute > 1000);
    CHECK(c.tested.nodes == file.cloud.nodes.size());
}

TEST_CASE("nothing wanted is an empty file, and only the hierarchy is read for it") {
    SmallCloudFile file(quarterGrid());
    PointFilter filter;
    filter.box = BoxD{{0, 0, 0}, {1, 1, 1}};
    WalkCounters c = compareExport(file, filter, [](std::size_t) { return false; });
    CHECK(c.bytesRead == 0);
    CHECK(c.outside.points == file.cloud.metadata.pointCount);
    ExportOptions options;
    options.filter = filter;
    exportOrFail(file.path, file.folder / "out.csv", options);
    CHECK(readCsv(textOf(file.folder / "out.csv")).rows.empty());
    exportOrFail(file.path, file.folder / "out.ply", options);
    CHECK(readPly(textOf(file.folder / "out.ply")).count == 0);
}

TEST_CASE("blocks of attributes that nobody asked for are not read") {
    SmallCloudFile file(quarterGrid());
    ExportOptions options;
    options.attributes = {{"Point Source ID"}};
    ExportResult one = exportOrFail(file.path, file.folder / "one.csv", options);
    ExportResult all = exportOrFail(file.path, file.folder / "all.csv");
    CHECK(all.counters.attributeBytesSkipped == 0);
    CHECK(one.counters.attributeBytesSkipped > 0);
    CHECK(one.counters.bytesRead + one.counters.attributeBytesSkipped == all.counters.bytesRead);
    // A condition's attribute is read where points are tested, and not written.
    options.filter.conditions = {{"Intensity", {{0, 1000}}}};
    ExportResult filtered = exportOrFail(file.path, file.folder / "some.csv", options);
    CHECK(filtered.attributes == std::vector<std::string>{"Point Source ID"});
    CHECK(filtered.counters.attributeBytesSkipped < one.counters.attributeBytesSkipped);
    CHECK(readCsv(textOf(file.folder / "some.csv")).names ==
          std::vector<std::string>{"X", "Y", "Z", "Point Source ID"});
}

TEST_CASE("hierarchy chunks below a region's outside are not read") {
    SmallCloudOptions options = quarterGrid();
    options.levels = 6;
    options.pointsPerNode = 4;
    SmallCloudFile file(options);
    AllPoints all = allPoints(file.path);
    PointFilter filter;
    filter.box = BoxD{{499925, 3999950, 0}, {499990, 4000010, 1000}};
    WalkCounters some =
        compareExport(file, filter, [&](std::size_t i) { return filter.box->contains(all.world(i)); });
    WalkCounters whole = compareExport(file, {}, [](std::size_t) { return true; });
    CHECK(whole.hierarchy.chunksSkipped == 0);
    REQUIRE(whole.hierarchy.chunksRead > 1);
    CHECK(some.hierarchy.chunksSkipped > 0);
    CHECK(some.hierarchy.chunksRead < whole.hierarchy.chunksRead);
    CHECK(knownNodes(some) < file.cloud.nodes.size());
}

TEST_CASE("the same points in the same order for any number of threads") {
    SmallCloudFile file(quarterGrid());
    for (const char* name : {"csv", "ply", "las"}) {
        ExportOptions options;
        options.filter.box = BoxD{{499900, 3999900, 0}, {500400, 4000300, 1000}};
        std::string first;
        for (int threads : {1, 2, 5}) {
            options.threads = threads;
            std::string path = file.folder / cat(threads, ".", name);
            exportOrFail(file.path, path, options);
            if (threads == 1)
                first = textOf(path);
            CHECK((textOf(path) == first));
        }
    }
}

TEST_CASE("a LAZ file has the same bytes for any number of threads, and the points of LAS") {
    for (int format : {2, 7}) {
        TemporaryFolder folder;
        writeScan(surfaceScan(format, 160000, 1), folder / "in.las"); // more than three chunks
        convertOrFail({folder / "in.las"}, folder / "c.stipple");
        exportOrFail(folder / "c.stipple", folder / "out.las");
        const LasContent las = readLas(folder / "out.las");
        std::string first;
        for (int threads : {1, 2, 5}) {
            ExportOptions options;
            options.threads = threads;
            exportOrFail(folder / "c.stipple", folder / "out.laz", options);
            if (threads == 1)
                first = textOf(folder / "out.laz");
            CHECK((textOf(folder / "out.laz") == first));
            requireEqual(readLas(folder / "out.laz").points, las.points);
        }
        // Interrupted while chunks wait: nothing is left, and nobody hangs.
        std::atomic<bool> stop{false};
        ExportOptions options;
        options.threads = 4;
        options.stop = &stop;
        auto result = exportFile(
            folder / "c.stipple", folder / "stopped.laz", options,
            [&](const std::string&, std::uint64_t done, std::uint64_t) { stop = stop || done > 20000; });
        REQUIRE_FALSE(result.ok());
        CHECK(result.error().code == ErrorCode::cancelled);
        CHECK(folder.files() == 4);
    }
}

TEST_CASE("a filter that means nothing is refused with a reason") {
    SmallCloudFile file;
    auto sentence = [&](const PointFilter& filter) {
        ExportOptions options;
        options.filter = filter;
        auto result = exportFile(file.path, file.folder / "out.las", options, noProgress);
        REQUIRE_FALSE(result.ok());
        CHECK(result.error().code == ErrorCode::invalidArgument);
        CHECK(file.folder.files() == 1);
        return result.error().sentence();
    };
    PointFilter box;
    box.box = BoxD{{5, 0, 0}, {4, 1, 1}};
    CHECK(sentence(box) == "the box is empty: its x goes from 5 to 4 (give the smaller corner first)");
    PointFilter unknown;
    unknown.conditions = {{"Classification", {{2, 2}}}};
    CHECK(sentence(unknown) ==
          "the cloud has no attribute \"Classification\" (it has Intensity, Point Source ID, "
          "Red, Green, Blue)");
    PointFilter spacing;
    spacing.spacing = -1;
    CHECK(sentence(spacing).find("no distance") != std::string::npos);
}
