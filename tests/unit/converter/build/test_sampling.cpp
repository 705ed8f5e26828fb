#include "converter/build/tile.hpp"
#include "tests/unit/converter/build/minimum_distance.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

#include <algorithm>

using namespace stipple;
using namespace stipple::test;

TEST_CASE("inner nodes keep the minimum distance, across the borders of nodes too", "[sample]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 400000, 11), folder / "in.las");
    convertOrFail({folder / "in.las"}, folder / "c.stipple");
    checkMinimumDistance(folder / "c.stipple");
}

// Of the root's children the dense one is sampled when all of its own are, after the one beside it.
TEST_CASE("the minimum distance holds where subtrees of different levels meet", "[sample]") {
    TemporaryFolder folder;
    TestScan scan = surfaceScan(0, 700000, 14);
    for (std::size_t i = 0; i < scan.points.positions.size(); ++i) {
        Vec3i& p = scan.points.positions[i];
        p = {i % 5 == 0 ? 32768 + p.x % 20000 : p.x % 32768, p.y % 32768, p.z % 20};
    }
    writeScan(scan, folder / "in.las");
    ConvertOptions options;
    options.sizes.subtreeBytes = 1 << 25;
    convertOrFail({folder / "in.las"}, folder / "c.stipple", options);
    checkMinimumDistance(folder / "c.stipple");
}

TEST_CASE("the minimum distance holds where the scales of the axes differ", "[sample]") {
    TemporaryFolder folder;
    TestScan scan = surfaceScan(0, 300000, 12);
    scan.grid.scale.z = 0.001;
    writeScan(scan, folder / "in.las");
    convertOrFail({folder / "in.las"}, folder / "c.stipple");
    checkMinimumDistance(folder / "c.stipple");
}

TEST_CASE("points that fill a volume are kept further apart, so that nodes stay in their size", "[sample]") {
    TemporaryFolder folder;
    TestScan scan = surfaceScan(0, 500000, 13);
    std::mt19937_64 random(13);
    for (Vec3i& p : scan.points.positions)
        p = {static_cast<std::int64_t>(random() % 60000), static_cast<std::int64_t>(random() % 60000),
             static_cast<std::int64_t>(random() % 60000)};
    writeScan(scan, folder / "in.las");
    convertOrFail({folder / "in.las"}, folder / "c.stipple");
    auto source = openFileSource(folder / "c.stipple");
    REQUIRE(source.ok());
    auto reader = CloudReader::open(**source);
    REQUIRE(reader.ok());
    double side = std::ldexp(0.01, (*reader)->metadata().rootCube.bits);
    CHECK(side / (*reader)->metadata().spacing < 100);
    std::uint32_t largest = 0;
    REQUIRE((*reader)
                ->visitNodes([&](const NodeEntry& entry) -> Status {
                    largest = std::max(largest, entry.pointCount);
                    return {};
                })
                .ok());
    CHECK(largest < 130000);
}

TEST_CASE("the root cube is the smallest power of two that holds the points", "[tile]") {
    auto cube = [](Vec3i min, Vec3i max) { return rootCubeOf(BoxI{min, max}); };
    CHECK(cube({5, 6, 7}, {5, 6, 7})->bits == 0);
    CHECK(cube({0, 0, 0}, {1, 0, 0})->bits == 1);
    CHECK(cube({-3, 0, 0}, {4, 0, 0})->bits == 3);
    CHECK(cube({-3, 0, 0}, {5, 0, 0})->bits == 4);
    CHECK(cube({-3, 0, 0}, {5, 0, 0})->min == Vec3i{-3, 0, 0});
    CHECK(cube({0, 0, 0}, {0, 0, (std::int64_t{1} << 52) - 1})->bits == 52);
    CHECK_FALSE(cube({0, 0, 0}, {0, 0, std::int64_t{1} << 52}).ok());
    CHECK_FALSE(cube({std::numeric_limits<std::int64_t>::min(), 0, 0},
                     {std::numeric_limits<std::int64_t>::max(), 0, 0})
                    .ok());
}
