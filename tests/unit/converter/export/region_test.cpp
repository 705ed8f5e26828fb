// Rotated boxes, profiles, values and limits against looking at every point.
#include "converter/export/filter_text.hpp"
#include "shared/base/text.hpp"
#include "shared/io/file_source.hpp"
#include "shared/select/corridor_attributes.hpp"
#include "shared/select/region_options.hpp"
#include "tests/unit/converter/export/export_fixture.hpp"

#include <cmath>

using namespace stipple;
using namespace stipple::test;

namespace {

constexpr double pi = 3.14159265358979323846;

// Whole numbers of rotated grids are not exact, so the comparison is made with more digits than doubles have;
// no point of these clouds is nearer to a side than that leaves open.
bool inTurnedBox(Vec3d p, Vec3d centre, Vec3d size, double degrees) {
    long double c = std::cos(degrees * static_cast<long double>(pi) / 180);
    long double s = std::sin(degrees * static_cast<long double>(pi) / 180);
    long double x = p.x - centre.x, y = p.y - centre.y;
    long double along = c * x + s * y, across = c * y - s * x;
    return std::abs(along) <= size.x / 2 && std::abs(across) <= size.y / 2 &&
           std::abs(p.z - centre.z) <= size.z / 2;
}

std::vector<std::uint32_t> allParts(const Corridor& corridor) {
    return corridor.partsNear({{-1e9, -1e9, 0}, {1e9, 1e9, 0}});
}

double numberAt(const PointBatch& points, std::size_t column, std::size_t row) {
    return loadLe<double>(points.columns[column].data() + 8 * row);
}

} // namespace

TEST_CASE("a rotated box takes the points a test of every point takes") {
    SmallCloudFile file(quarterGrid());
    AllPoints all = allPoints(file.path);
    for (double degrees : {0.0, 30.0, 90.0, -72.5}) {
        INFO(degrees);
        Vec3d centre{500300.1, 4000350.3, 500.7}, size{610.3, 210.7, 700.9};
        std::vector<double> c{centre.x, centre.y, centre.z}, s{size.x, size.y, size.z}, r{degrees};
        PointFilter filter;
        filter.convex = need(rotatedBox(c, s, r));
        WalkCounters counters = compareExport(
            file, filter, [&](std::size_t i) { return inTurnedBox(all.world(i), centre, size, degrees); });
        CHECK(counters.pointsTaken > 100);
        CHECK(counters.outside.nodes > 0);
        CHECK(counters.dropped.byRegion > 0);
        // Any height, together with a range of heights.
        filter.convex = need(rotatedBox(std::span(c).first(2), std::span(s).first(2), r));
        limitHeights(filter, {200, 300});
        Vec3d endless{size.x, size.y, 1e9};
        compareExport(file, filter, [&](std::size_t i) {
            Vec3d p = all.world(i);
            return p.z >= 200 && p.z <= 300 && inTurnedBox(p, centre, endless, degrees);
        });
    }
}

TEST_CASE("nodes wholly in a rotated box are taken without a test") {
    SmallCloudFile file(quarterGrid());
    AllPoints all = allPoints(file.path);
    std::vector<double> centre{500440, 4000460}, size{900, 900}, rotation{45};
    PointFilter filter;
    filter.convex = need(rotatedBox(centre, size, rotation));
    WalkCounters c = compareExport(file, filter, [&](std::size_t i) {
        return inTurnedBox(all.world(i), {500440, 4000460, 0}, {900, 900, 1e9}, 45);
    });
    CHECK(c.whole.nodes > 10);
    CHECK(c.tested.nodes > 5);
}

TEST_CASE("a profile takes the points of its corridor once, with station and offset") {
    SmallCloudFile file(quarterGrid());
    AllPoints all = allPoints(file.path);
    PointFilter filter;
    std::vector<Point2d> line =
        need(lineFromText("500010,4000020;500700,4000100;500650,4000800;500100,4000500"));
    filter.corridor = std::make_shared<const Corridor>(need(Corridor::make(line, 120)));
    ExportOptions options;
    options.filter = filter;
    ExportResult result = exportOrFail(file.path, file.folder / "out.las", options);
    CHECK(result.attributes.size() == all.metadata.schema.attributes.size() + 2);
    CHECK(result.attributes.back() == "Offset");
    auto inCorridor = [&](std::size_t i) {
        Vec3d p = all.world(i);
        return filter.corridor->contains({p.x, p.y}, allParts(*filter.corridor));
    };
    PointBatch expected = rowsWhere(all, inCorridor);
    CHECK(expected.size() > 500);
    CHECK(result.counters.outside.nodes > 0);
    CHECK(result.points == expected.size());

    LasContent las = readLas(file.folder / "out.las");
    auto station = static_cast<std::size_t>(las.schema.find("Station"));
    auto offset = static_cast<std::size_t>(las.schema.find("Offset"));
    REQUIRE(station < las.points.columns.size());
    REQUIRE(offset < las.points.columns.size());
    for (std::size_t i = 0; i < las.points.size(); ++i) {
        Vec3d p = all.metadata.grid.toWorld(las.points.positions[i]);
        auto place = filter.corridor->placeOf({p.x, p.y}, allParts(*filter.corridor));
        REQUIRE(place);
        REQUIRE(numberAt(las.points, station, i) == place->station);
        REQUIRE(numberAt(las.points, offset, i) == place->offset);
    }
    PointBatch found;
    found.positions = las.points.positions;
    for (const Attribute& attribute : all.metadata.schema.attributes)
        found.columns.push_back(
            las.points.columns[static_cast<std::size_t>(las.schema.find(attribute.name))]);
    requireEqual(found, expected);

    // The same in the other formats, and for any number of threads.
    for (const char* name : {"out.csv", "out.ply", "out.laz"}) {
        std::string first;
        for (int threads : {1, 3}) {
            options.threads = threads;
            exportOrFail(file.path, file.folder / name, options);
            if (threads == 1)
                first = textOf(file.folder / name);
            CHECK((textOf(file.folder / name) == first));
        }
    }
    CsvContent csv = readCsv(textOf(file.folder / "out.csv"));
    PlyContent ply = readPly(textOf(file.folder / "out.ply"));
    REQUIRE(csv.names[csv.names.size() - 2] == "Station");
    for (std::size_t i = 0; i < las.points.size(); ++i) {
        REQUIRE(std::stod(csv.rows[i][csv.names.size() - 2]) == numberAt(las.points, station, i));
        REQUIRE(ply.values.at("Offset")[i] == numberAt(las.points, offset, i));
    }
}

TEST_CASE("a profile and other conditions hold together") {
    SmallCloudFile file(quarterGrid());
    AllPoints all = allPoints(file.path);
    int intensity = all.metadata.schema.find("Intensity");
    ExportOptions options;
    PointFilter& filter = options.filter;
    std::vector<Point2d> line = need(lineFromText("500010,4000020;500900,4000900"));
    filter.corridor = std::make_shared<const Corridor>(need(Corridor::make(line, 200)));
    filter.conditions = need(conditionsFromText("Intensity:..30000"));
    options.attributes = {{"Red"}}; // not the one that is tested
    ExportResult result = exportOrFail(file.path, file.folder / "out.csv", options);
    PointBatch expected = rowsWhere(all, [&](std::size_t i) {
        Vec3d p = all.world(i);
        return filter.corridor->contains({p.x, p.y}, allParts(*filter.corridor)) &&
               all.points.value<std::uint16_t>(intensity, i) <= 30000;
    });
    CHECK(result.points == expected.size());
    CHECK(expected.size() > 100);
    CHECK(readCsv(textOf(file.folder / "out.csv")).names ==
          std::vector<std::string>{"X", "Y", "Z", "Red", "Station", "Offset"});
}

TEST_CASE("names that a cloud has already are not given to station and offset") {
    CloudMetadata metadata;
    metadata.schema.attributes = {{"Station", AttributeType::u8}, {"Station (2)", AttributeType::u8}};
    addCorridorAttributes(metadata);
    REQUIRE(metadata.schema.attributes.size() == 4);
    CHECK(metadata.schema.attributes[2].name == "Station (3)");
    CHECK(metadata.schema.attributes[3].name == "Offset");
}

TEST_CASE("conditions on scaled attributes are on the values they mean") {
    TemporaryFolder folder;
    TestScan scan = surfaceScan(6, 0, 7);
    Attribute height{"Height", AttributeType::i16};
    height.scale = 0.1;
    height.offset = -3;
    height.noData = -100; // means -13
    scan.schema.attributes.push_back(height);
    scan.points.resize(scan.schema, 3000);
    for (std::size_t i = 0; i < 3000; ++i) {
        scan.points.positions[i] = {static_cast<std::int64_t>(i), static_cast<std::int64_t>(i * 7 % 3000), 0};
        scan.points.setValue<std::int16_t>(scan.schema.find("Height"), i,
                                           static_cast<std::int16_t>(i * 37 % 401) - 200);
    }
    writeScan(scan, folder / "in.las");
    convertOrFail({folder / "in.las"}, folder / "c.stipple");
    AllPoints all = allPoints(folder / "c.stipple");
    int column = all.metadata.schema.find("Height");
    REQUIRE(column >= 0);
    REQUIRE(all.metadata.schema.attributes[static_cast<std::size_t>(column)].noData == -100);
    auto count = [&](const char* where) {
        ExportOptions options;
        options.filter.conditions = need(conditionsFromText(where));
        return exportOrFail(folder / "c.stipple", folder / "out.csv", options).points;
    };
    auto expected = [&](int low, int high) { // stored
        return rowsWhere(all,
                         [&](std::size_t i) {
                             auto value = all.points.value<std::int16_t>(column, i);
                             return value >= low && value <= high && value != -100;
                         })
            .size();
    };
    CHECK(expected(33, 57) > 100);
    CHECK(count("Height:0.3..2.7") == expected(33, 57)); // neither 0.3 nor 0.1 is a double
    CHECK(count("Height:0.31..2.69") == expected(34, 56));
    CHECK(count("height:-13") == 0); // no value
    CHECK(count("Height:..-12.9") == expected(-200, -99));
}

TEST_CASE("a limit takes the first points in the order of the file, and reads little more") {
    SmallCloudFile file(quarterGrid());
    AllPoints all = allPoints(file.path);
    PointFilter part;
    part.box = BoxD{{500000, 4000000, -1e9}, {500400, 4000300, 1e9}};
    for (const PointFilter& filter : {PointFilter{}, part})
        for (std::uint64_t limit : {1u, 399u, 400u, 401u, 3000u, 1000000u})
            for (int threads : {1, 3}) {
                INFO(limit << " points, " << threads << " threads");
                std::uint64_t taken = 0;
                PointBatch expected = rowsWhere(all, [&](std::size_t i) {
                    return (!filter.box || filter.box->contains(all.world(i))) && taken++ < limit;
                });
                ExportOptions options;
                options.filter = filter;
                options.limit = limit;
                options.threads = threads;
                ExportResult result = exportOrFail(file.path, file.folder / "out.las", options);
                CHECK(result.points == expected.size());
                LasContent las = readLas(file.folder / "out.las");
                CHECK((las.points.positions == expected.positions));
                const WalkCounters& c = result.counters;
                CHECK(c.whole.points + c.tested.points ==
                      c.pointsTaken + c.droppedByLimit + c.dropped.byRegion);
                CHECK(c.whole.bytes + c.tested.bytes == c.bytesRead + c.attributeBytesSkipped);
                if (!filter.box && limit <= 400)
                    CHECK(c.whole.nodes == 1);
            }
}

TEST_CASE("a limit also holds for what is counted before") {
    SmallCloudFile file(quarterGrid());
    auto source = need(openFileSource(file.path));
    auto reader = need(CloudReader::open(*source));
    PointFilter part;
    part.box = BoxD{{500000, 4000000, -1e9}, {500400, 4000300, 1e9}};
    for (const PointFilter& wanted : {PointFilter{}, part}) {
        CloudFilter filter = need(CloudFilter::make(reader->metadata(), wanted));
        std::uint64_t all = need(countPoints(*reader, "c", filter, {}));
        CHECK(need(tallyNodes(*reader, filter, {})).points >= all);
        for (std::uint64_t limit : {std::uint64_t{1}, std::uint64_t{777}, all - 1, all, all + 1}) {
            WalkOptions options;
            options.limit = limit;
            CHECK(need(countPoints(*reader, "c", filter, options)) == std::min(all, limit));
        }
    }
}

TEST_CASE("rotated boxes that are none are refused by the part that is wrong") {
    auto refusal = [](std::vector<double> centre, std::vector<double> size, std::vector<double> rotation) {
        auto box = rotatedBox(centre, size, rotation);
        REQUIRE_FALSE(box.ok());
        return box.error().where + ": " + box.error().what;
    };
    CHECK(refusal({1}, {1}, {}) == "center: it is no place");
    CHECK(refusal({1, 2, 3}, {1, 1}, {}) == "size: it does not fit the centre");
    CHECK(refusal({1, 2, 3}, {1, -1, 1}, {}) == "size: a size is negative");
    CHECK(refusal({1, 2}, {1, 1}, {0, 0, 0, 1}) == "rotation: it does not fit the box");
    CHECK(refusal({1, 2, 3}, {1, 1, 1}, {0, 0}) == "rotation: it does not fit the box");
    CHECK(refusal({1, 2, 3}, {1, 1, 1}, {0, 0, 0, 0}) == "rotation: a quaternion of length 0 turns nothing");
    CHECK(refusal({1e200, 2, 3}, {1, 1, 1}, {}) == "center: the box's centre is out of range");
}
