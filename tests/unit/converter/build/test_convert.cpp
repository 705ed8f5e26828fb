#include "converter/build/verify.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

#include <algorithm>
#include <numeric>

using namespace stipple;
using namespace stipple::test;

namespace {
// The same points in another order.
TestScan shuffled(const TestScan& scan, std::uint64_t seed) {
    std::vector<std::size_t> order(scan.points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937_64(seed));
    TestScan result = scan;
    for (std::size_t i = 0; i < order.size(); ++i) {
        result.points.positions[i] = scan.points.positions[order[i]];
        for (std::size_t a = 0; a < scan.schema.attributes.size(); ++a) {
            std::size_t size = scan.schema.attributes[a].size();
            std::memcpy(result.points.columns[a].data() + i * size,
                        scan.points.columns[a].data() + order[i] * size, size);
        }
    }
    return result;
}

TestScan scanOf(std::vector<Vec3i> positions) {
    TestScan scan;
    scan.schema = las::schemaOf(0);
    scan.points.resize(scan.schema, positions.size());
    scan.points.positions = std::move(positions);
    std::mt19937_64 random(1);
    fillAttributes(scan, random);
    return scan;
}

void convertAndVerify(const TestScan& scan) {
    TemporaryFolder folder;
    writeScan(scan, folder / "in.las");
    ConvertResult result = convertOrFail({folder / "in.las"}, folder / "out.stipple");
    CHECK(result.metadata.pointCount == scan.points.size());
    auto report = verifyFile(folder / "out.stipple", {folder / "in.las"}, {.threads = 2}, noProgress);
    REQUIRE(report.ok());
    INFO((report->faults.empty() ? "" : report->faults[0]));
    CHECK(report->passed());
    CHECK(report->comparison->equalPoints == scan.points.size());
}
} // namespace

TEST_CASE("the same points give the same bytes, in any order and with any number of threads", "[convert]") {
    TestScan scan = surfaceScan(3, 150000, 7);
    TemporaryFolder one, two;
    writeScan(scan, one / "scan.las");
    writeScan(shuffled(scan, 99), two / "scan.las");
    ConvertOptions oneThread, threeThreads;
    oneThread.threads = 1;
    threeThreads.threads = 3;
    convertOrFail({one / "scan.las"}, one / "out.stipple", oneThread);
    convertOrFail({two / "scan.las"}, two / "out.stipple", threeThreads);
    CHECK(fileBytes(one / "out.stipple") == fileBytes(two / "out.stipple"));
}

TEST_CASE("the order of the inputs does not matter", "[convert]") {
    TemporaryFolder folder;
    TestScan a = surfaceScan(1, 40000, 1), b = surfaceScan(7, 50000, 2);
    b.grid = {{0.001, 0.001, 0.001}, {500100, 4000000, 0}};
    writeScan(a, folder / "a.las");
    writeScan(b, folder / "b.las");
    convertOrFail({folder / "a.las", folder / "b.las"}, folder / "ab.stipple", {.name = "x"});
    convertOrFail({folder / "b.las", folder / "a.las"}, folder / "ba.stipple", {.name = "x"});
    CHECK(fileBytes(folder / "ab.stipple") == fileBytes(folder / "ba.stipple"));
}

TEST_CASE("inputs of other formats and grids become one cloud with nothing lost", "[convert]") {
    TemporaryFolder folder;
    TestScan a = surfaceScan(1, 5000, 1), b = surfaceScan(7, 6000, 2);
    b.grid = {{0.001, 0.001, 0.001}, {500100, 4000000, 0}};
    writeScan(a, folder / "a.las");
    writeScan(b, folder / "b.las");
    ConvertResult result = convertOrFail({folder / "a.las", folder / "b.las"}, folder / "out.stipple");
    CHECK(result.metadata.grid.scale.x == 0.001);
    CHECK(result.metadata.schema.find("Scan Angle") >= 0);
    CHECK(result.metadata.schema.find("Scan Angle Rank") >= 0);
    bool told = std::any_of(result.warnings.begin(), result.warnings.end(), [](const std::string& warning) {
        return warning.find("a.las: filled with 0") != std::string::npos &&
               warning.find("Red") != std::string::npos;
    });
    CHECK(told);
    auto report =
        verifyFile(folder / "out.stipple", {folder / "b.las", folder / "a.las"}, {.threads = 1}, noProgress);
    REQUIRE(report.ok());
    CHECK(report->passed());
    CHECK(report->points == 11000);
}

TEST_CASE("clouds without points, or with one, are clouds", "[convert]") {
    convertAndVerify(scanOf({}));
    convertAndVerify(scanOf({{5, -6, 7}}));
}

TEST_CASE("points that are all at one place stay", "[convert]") {
    convertAndVerify(scanOf(std::vector<Vec3i>(100000, Vec3i{1, 2, 3})));
}

TEST_CASE("points on a line, and points at the ends of the 32-bit range, stay", "[convert]") {
    std::vector<Vec3i> line;
    for (int i = 0; i < 100000; ++i)
        line.push_back({i * 3, i * 3, i * 3});
    convertAndVerify(scanOf(line));
    constexpr std::int64_t low = std::numeric_limits<std::int32_t>::min();
    constexpr std::int64_t high = std::numeric_limits<std::int32_t>::max();
    convertAndVerify(scanOf({{low, low, low}, {high, high, high}, {0, 0, 0}}));
}

TEST_CASE("a dense cluster in an empty plain loses no point", "[convert]") {
    std::vector<Vec3i> points{{-2000000000, 0, 0}, {2000000000, 2000000000, 0}};
    std::mt19937_64 random(3);
    for (int i = 0; i < 80000; ++i)
        points.push_back({static_cast<std::int64_t>(random() % 40), static_cast<std::int64_t>(random() % 40),
                          static_cast<std::int64_t>(random() % 4)});
    convertAndVerify(scanOf(points));
}

TEST_CASE("clouds wider than 2^31 steps have wide nodes without points", "[convert]") {
    TemporaryFolder folder;
    TestScan a = scanOf({{0, 0, 0}, {10, 20, 30}}), b = a;
    b.grid.offset.x += 1e9; // 10^11 steps away
    writeScan(a, folder / "a.las");
    writeScan(b, folder / "b.las");
    ConvertResult result = convertOrFail({folder / "a.las", folder / "b.las"}, folder / "out.stipple");
    CHECK(result.metadata.rootCube.bits == 37);
    auto report =
        verifyFile(folder / "out.stipple", {folder / "a.las", folder / "b.las"}, {.threads = 1}, noProgress);
    REQUIRE(report.ok());
    INFO((report->faults.empty() ? "" : report->faults[0]));
    CHECK(report->passed());
}

TEST_CASE("the picture's colour is the best that varies", "[convert]") {
    TemporaryFolder folder;
    TestScan scan = surfaceScan(2, 100, 1);
    writeScan(scan, folder / "rgb.las");
    CHECK(convertOrFail({folder / "rgb.las"}, folder / "o.stipple").metadata.pictureColour ==
          PictureColour::rgb);
    for (const char* name : {"Red", "Green", "Blue"})
        for (std::size_t i = 0; i < scan.points.size(); ++i)
            scan.points.setValue<std::uint16_t>(scan.schema.find(name), i, static_cast<std::uint16_t>(i));
    writeScan(scan, folder / "small.las");
    CHECK(convertOrFail({folder / "small.las"}, folder / "o.stipple").metadata.colourIs8Bit);
    for (const char* name : {"Red", "Green", "Blue"})
        for (std::size_t i = 0; i < scan.points.size(); ++i)
            scan.points.setValue<std::uint16_t>(scan.schema.find(name), i, 0);
    writeScan(scan, folder / "black.las");
    CHECK(convertOrFail({folder / "black.las"}, folder / "o.stipple").metadata.pictureColour ==
          PictureColour::intensity);
    for (std::size_t i = 0; i < scan.points.size(); ++i)
        scan.points.setValue<std::uint16_t>(scan.schema.find("Intensity"), i, 77);
    writeScan(scan, folder / "flat.las");
    CHECK(convertOrFail({folder / "flat.las"}, folder / "o.stipple").metadata.pictureColour ==
          PictureColour::none);
}

TEST_CASE("a header whose bounds lie is reported, and the points' bounds are used", "[convert]") {
    TemporaryFolder folder;
    TestScan scan = surfaceScan(0, 1000, 1);
    writeScan(scan, folder / "in.las");
    Bytes bytes = fileBytes(folder / "in.las");
    storeLe<double>(bytes.data() + 179, 9e9); // max x (LAS 1.4 §2.4)
    std::ofstream(folder / "in.las", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    ConvertResult result = convertOrFail({folder / "in.las"}, folder / "out.stipple");
    bool told = std::any_of(result.warnings.begin(), result.warnings.end(), [](const std::string& warning) {
        return warning.find("9000000000") != std::string::npos;
    });
    CHECK(told);
    CHECK(result.metadata.worldBounds().max.x < 600000);
}
