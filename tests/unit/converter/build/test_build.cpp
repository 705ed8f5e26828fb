// Clouds of many subtrees and several tiers, made of few points.
#include "converter/build/verify.hpp"
#include "tests/unit/converter/build/minimum_distance.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

#include <algorithm>

using namespace stipple;
using namespace stipple::test;

namespace {
constexpr std::uint64_t smallSubtrees = std::uint64_t{1} << 20; // of some 10,000 points

ConvertOptions pieces(std::uint64_t memoryBytes = 0, int threads = 2) {
    ConvertOptions options;
    options.name = "cloud";
    options.memoryBytes = memoryBytes;
    options.threads = threads;
    options.sizes = {.pointsPerRound = 50000, .subtreeBytes = smallSubtrees};
    options.innerColour = InnerColour::mean; // of intensities: sums go from tier to tier
    return options;
}

TestScan scanOf(std::vector<Vec3i> positions) {
    TestScan scan;
    scan.schema = las::schemaOf(1);
    scan.pointFormat = 1;
    scan.points.resize(scan.schema, positions.size());
    scan.points.positions = std::move(positions);
    std::mt19937_64 random(positions.size());
    fillAttributes(scan, random);
    return scan;
}

Vec3i within(std::uint64_t width, std::mt19937_64& random) {
    auto number = [&] { return static_cast<std::int64_t>(random() % width); };
    std::int64_t x = number(), y = number(), z = number();
    return {x, y, z};
}

// Converts in pieces, with and without room for the points in memory, and compares every point with the
// inputs.
void checkNothingLost(const std::vector<TestScan>& scans) {
    TemporaryFolder folder;
    std::vector<std::string> inputs;
    std::uint64_t count = 0;
    for (const TestScan& scan : scans) {
        inputs.push_back(folder / ("in" + std::to_string(inputs.size()) + ".las"));
        writeScan(scan, inputs.back());
        count += scan.points.size();
    }
    Bytes first;
    for (std::uint64_t memoryBytes : {1u, 1u << 30}) {
        INFO("memory for points: " << memoryBytes);
        ConvertResult result = convertOrFail(inputs, folder / "out.stipple", pieces(memoryBytes));
        CHECK(result.metadata.pointCount == count);
        auto report = verifyFile(folder / "out.stipple", inputs, {.threads = 2}, noProgress);
        REQUIRE(report.ok());
        INFO((report->faults.empty() ? "" : report->faults[0]));
        CHECK(report->passed());
        REQUIRE(report->comparison.has_value());
        CHECK(report->comparison->equalPoints == count);
        CHECK(folder.files() == inputs.size() + 1);
        Bytes bytes = fileBytes(folder / "out.stipple");
        CHECK((first.empty() || first == bytes));
        first = std::move(bytes);
    }
}

void checkNothingLost(std::vector<Vec3i> positions) {
    checkNothingLost(std::vector<TestScan>{scanOf(std::move(positions))});
}
} // namespace

TEST_CASE("300,000 points at one place all stay", "[build]") {
    checkNothingLost(std::vector<Vec3i>(300000, Vec3i{1, 2, 3}));
}

TEST_CASE("a single point and none at all are clouds in pieces, too", "[build]") {
    checkNothingLost(std::vector<Vec3i>{});
    checkNothingLost(std::vector<Vec3i>{{-7, 8, 9}});
}

TEST_CASE("points on a line stay", "[build]") {
    std::vector<Vec3i> points;
    for (int i = 0; i < 100000; ++i)
        points.push_back({17 * i, 5, -3 * i});
    checkNothingLost(points);
}

TEST_CASE("a dense cluster in an empty square kilometre stays", "[build]") {
    std::vector<Vec3i> points{{0, 0, 0}, {100000, 100000, 0}}; // centimetres
    std::mt19937_64 random(1);
    for (int i = 0; i < 120000; ++i)
        points.push_back(Vec3i{70000, 30000, 100} + within(100, random));
    checkNothingLost(points);
}

TEST_CASE("piles of more points than a subtree holds stay, beside each other and alone", "[build]") {
    std::mt19937_64 random(2);
    std::vector<Vec3i> points;
    for (int i = 0; i < 60000; ++i)
        points.push_back(within(50000, random));
    for (Vec3i pile : {Vec3i{100, 100, 100}, Vec3i{101, 100, 100}, Vec3i{40000, 40000, 40000}})
        points.insert(points.end(), 40000, pile);
    checkNothingLost(points);
}

TEST_CASE("100 files of wildly different densities become one cloud", "[build]") {
    std::mt19937_64 random(3);
    std::vector<TestScan> scans;
    for (int i = 0; i < 100; ++i) {
        std::vector<Vec3i> points;
        std::size_t count = i % 10 == 0 ? 15000 : random() % 20; // one in ten is dense
        std::uint64_t width = i % 10 == 0 ? 200 : 100000;
        Vec3i corner = within(5000000, random);
        for (std::size_t p = 0; p < count; ++p)
            points.push_back(corner + within(width, random));
        scans.push_back(scanOf(std::move(points)));
    }
    checkNothingLost(scans);
}

TEST_CASE("clusters 2^40 steps apart stay, each in subtrees of its own", "[build]") {
    std::mt19937_64 random(4);
    std::vector<TestScan> scans;
    for (double far : {0.0, 1e10, 5e9}) { // 2^40 steps of a centimetre
        std::vector<Vec3i> points;
        for (int i = 0; i < 40000; ++i)
            points.push_back(within(30000, random));
        scans.push_back(scanOf(std::move(points)));
        scans.back().grid.offset = scans.back().grid.offset + Vec3d{far, far / 4, 0};
    }
    checkNothingLost(scans);
}

TEST_CASE("nodes too wide to hold points stand between the tiers", "[build]") {
    // Four corners of a square 2^34 steps wide, in one corner of one 2^40 steps wide: the nodes above a
    // corner, wider than 2^31 steps, have no sample, and more points than a subtree holds lie below.
    std::mt19937_64 random(5);
    std::vector<TestScan> scans;
    for (Vec3d at :
         {Vec3d{0, 0, 0}, Vec3d{1e8, 0, 0}, Vec3d{0, 1e8, 0}, Vec3d{1e8, 1e8, 0}, Vec3d{1e10, 0, 0}}) {
        std::vector<Vec3i> points;
        for (int i = 0; i < 9000; ++i)
            points.push_back(within(i % 2 == 0 ? 30 : 2000000000, random));
        scans.push_back(scanOf(std::move(points)));
        scans.back().grid.offset = scans.back().grid.offset + at;
    }
    checkNothingLost(scans);
}

TEST_CASE("several tiers give the same bytes for any threads, memory and order of inputs", "[build]") {
    TemporaryFolder folder;
    TestScan a = surfaceScan(3, 70000, 1), b = surfaceScan(3, 30000, 2);
    for (Vec3i& p : b.points.positions)
        p = {p.x / 4 + 20000, p.y / 4 + 9000, p.z + 40};
    writeScan(a, folder / "a.las");
    writeScan(b, folder / "b.las");
    std::vector<std::string> inputs{folder / "a.las", folder / "b.las"};
    convertOrFail(inputs, folder / "first.stipple", pieces(0, 1));
    Bytes first = fileBytes(folder / "first.stipple");
    for (int threads = 1; threads <= 3; ++threads)
        for (std::uint64_t memoryBytes : {std::uint64_t{1} << 20, std::uint64_t{1} << 26, std::uint64_t{0}}) {
            INFO(threads << " threads, memory " << memoryBytes);
            std::reverse(inputs.begin(), inputs.end());
            ConvertResult result = convertOrFail(inputs, folder / "c.stipple", pieces(memoryBytes, threads));
            CHECK((result.temporaryBytes > 0) == (memoryBytes == std::uint64_t{1} << 20));
            CHECK((fileBytes(folder / "c.stipple") == first));
        }
}

TEST_CASE("the minimum distance holds across the borders of subtrees and tiers", "[build]") {
    TemporaryFolder folder;
    TestScan scan = surfaceScan(0, 300000, 21);
    writeScan(scan, folder / "in.las");
    convertOrFail({folder / "in.las"}, folder / "c.stipple", pieces());
    checkMinimumDistance(folder / "c.stipple");
}
