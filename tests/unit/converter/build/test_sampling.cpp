#include "converter/build/tile.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/file_source.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

#include <algorithm>
#include <cmath>
#include <map>

using namespace stipple;
using namespace stipple::test;

namespace {
struct NodePoint {
    Vec3d world;
    std::size_t node = 0;
};

// Pairs nearer than `distance`, found by a sweep along x; counts points that have one in their own node and
// in another.
struct NearCounts {
    std::size_t points = 0, nearInside = 0, nearAcross = 0;
};
NearCounts countNear(std::vector<NodePoint> points, double distance) {
    std::sort(points.begin(), points.end(),
              [](const NodePoint& a, const NodePoint& b) { return a.world.x < b.world.x; });
    std::vector<std::uint8_t> inside(points.size()), across(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = i + 1; j < points.size() && points[j].world.x - points[i].world.x < distance;
             ++j) {
            if (length(points[j].world - points[i].world) >= distance * (1 - 1e-9))
                continue;
            auto& which = points[i].node == points[j].node ? inside : across;
            which[i] = which[j] = 1;
        }
    NearCounts counts;
    counts.points = points.size();
    counts.nearInside = static_cast<std::size_t>(std::count(inside.begin(), inside.end(), 1));
    counts.nearAcross = static_cast<std::size_t>(std::count(across.begin(), across.end(), 1));
    return counts;
}

// The points of inner nodes, by level.
std::map<int, std::vector<NodePoint>> innerPoints(CloudReader& reader) {
    std::map<int, std::vector<NodePoint>> levels;
    std::size_t node = 0;
    REQUIRE(reader
                .visitNodes([&](const NodeEntry& entry) -> Status {
                    ++node;
                    if (entry.childMask == 0)
                        return {};
                    STIPPLE_TRY(batch, reader.readNode(entry));
                    for (Vec3i p : batch.positions)
                        levels[entry.key.level].push_back({reader.metadata().grid.toWorld(p), node});
                    return {};
                })
                .ok());
    return levels;
}

void checkMinimumDistance(const std::string& cloud) {
    auto source = openFileSource(cloud);
    REQUIRE(source.ok());
    auto reader = CloudReader::open(**source);
    REQUIRE(reader.ok());
    auto levels = innerPoints(**reader);
    CHECK(levels.size() >= 2);
    for (const auto& [level, points] : levels) {
        INFO("level " << level);
        NearCounts counts = countNear(points, std::ldexp((*reader)->metadata().spacing, -level));
        CHECK(counts.nearInside == 0);
        CHECK(counts.nearAcross == 0);
        CHECK(counts.points > 1000);
    }
}
} // namespace

TEST_CASE("inner nodes keep the minimum distance, across the borders of nodes too", "[sample]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 400000, 11), folder / "in.las");
    convertOrFail({folder / "in.las"}, folder / "c.stipple");
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
