// The best points against ranking every point.
#include "converter/export/filter_text.hpp"
#include "converter/export/nearest_points.hpp"
#include "shared/io/file_source.hpp"
#include "shared/io/memory_source.hpp"
#include "tests/unit/converter/export/export_fixture.hpp"

#include <algorithm>
#include <cmath>
#include <random>

using namespace stipple;
using namespace stipple::test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Fixture {
    SmallCloudFile file;
    AllPoints all = allPoints(file.path);
    std::unique_ptr<ByteSource> source = need(openFileSource(file.path));
    std::unique_ptr<CloudReader> reader = need(CloudReader::open(*source));
    std::mt19937_64 random{9};

    explicit Fixture(SmallCloudOptions options = quarterGrid()) : file(options) {}

    // What a plain loop over all points finds.
    template <class Passes>
    std::vector<RankedPoint> bruteForce(const PointRank& rank, std::size_t count, Passes passes) const {
        std::vector<RankedPoint> found;
        std::uint32_t index = 0;
        for (std::size_t i = 0; i < all.points.size(); ++i) {
            index = i > 0 && all.nodes[i].key == all.nodes[i - 1].key ? index + 1 : 0;
            if (auto value = rank.rankOf(all.world(i)); value && passes(i))
                found.push_back({*value, all.nodes[i], index, all.points.positions[i]});
        }
        std::sort(found.begin(), found.end());
        found.resize(std::min(found.size(), count));
        return found;
    }

    template <class Passes>
    NearestCounters compare(const PointFilter& wanted, const PointRank& rank, std::size_t count,
                            Passes passes) const {
        CloudFilter filter = need(CloudFilter::make(reader->metadata(), wanted));
        NearestPoints found = need(nearestPoints(*reader, "c", filter, rank, count, nullptr));
        std::vector<RankedPoint> expected = bruteForce(rank, count, passes);
        REQUIRE(found.points.size() == expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i) {
            REQUIRE(found.points[i].rank == expected[i].rank);
            REQUIRE(found.points[i].node.key == expected[i].node.key);
            REQUIRE(found.points[i].index == expected[i].index);
            REQUIRE(found.points[i].position == expected[i].position);
        }
        return found.counters;
    }

    Vec3d somewhere(double around) {
        std::uniform_real_distribution<double> unit(-1, 1);
        Vec3d middle = reader->metadata().grid.toWorld({1700, 1800, 2000});
        return middle + Vec3d{unit(random), unit(random), unit(random)} * around;
    }
};

bool always(std::size_t) {
    return true;
}

} // namespace

TEST_CASE("the nearest points are those that looking at every point finds") {
    Fixture f;
    std::uint64_t nodes = 0, searches = 0;
    for (int i = 0; i < 60; ++i) {
        Vec3d place = f.somewhere(i % 3 == 0 ? 5000 : 600); // also from far outside
        for (std::size_t count : {std::size_t{1}, std::size_t{7}, std::size_t{300}})
            for (bool inPlan : {false, true}) {
                nodes += f.compare({}, DistanceRank(place, inPlan, infinity), count, always).nodesRead;
                ++searches;
            }
    }
    CHECK(nodes / searches < f.file.cloud.nodes.size() / 2); // and most nodes are left alone
}

TEST_CASE("points beyond the greatest distance do not count") {
    Fixture f;
    for (double most : {0.0, 3.0, 20.0, 100.0})
        for (int i = 0; i < 20; ++i)
            f.compare({}, DistanceRank(f.somewhere(500), false, most), 10, always);
    // A distance that is one to the last bit counts.
    Vec3d at = f.all.world(17);
    Vec3d place = at + Vec3d{3, 4, 0};
    f.compare({}, DistanceRank(place, false, 5), 3, always);
    CloudFilter everything = need(CloudFilter::make(f.reader->metadata(), {}));
    CHECK(need(nearestPoints(*f.reader, "c", everything, DistanceRank(at, false, 0), 1, nullptr))
              .points.size() == 1);
    NearestPoints none =
        need(nearestPoints(*f.reader, "c", everything, DistanceRank({0, 0, 0}, false, 1000), 1, nullptr));
    CHECK(none.points.empty());
    CHECK(none.counters.nodesRead == 0);
}

TEST_CASE("equally good points go by node and index") {
    SmallCloudOptions options = quarterGrid();
    options.rootCube = {{0, 0, 0}, 3}; // many points on the same steps
    options.levels = 2;
    Fixture f(options);
    for (int i = 0; i < 10; ++i)
        f.compare({}, DistanceRank(f.all.world(static_cast<std::size_t>(i) * 100), false, infinity), 50,
                  always);
}

TEST_CASE("the first points along a ray are those that looking at every point finds") {
    Fixture f;
    std::uint64_t nodes = 0, searches = 0, found = 0;
    for (int i = 0; i < 150; ++i) {
        Vec3d origin = f.somewhere(i % 2 == 0 ? 300 : 3000);
        Vec3d direction = f.somewhere(400) - origin;
        if (i % 10 == 0)
            direction = {0, 0, -2};
        double radius = i % 3 == 0 ? 0 : 10, slope = i % 3 == 1 ? 0 : 0.02,
               most = i % 5 == 0 ? 700 : infinity;
        RayRank rank(origin, direction, radius, slope, most);
        for (std::size_t count : {std::size_t{1}, std::size_t{20}}) {
            nodes += f.compare({}, rank, count, always).nodesRead;
            found += f.bruteForce(rank, count, always).size();
            ++searches;
        }
    }
    CHECK(found > searches);
    CHECK(nodes / searches < f.file.cloud.nodes.size() / 3);
}

TEST_CASE("a filter chooses among the points before the best are taken") {
    Fixture f;
    int intensity = f.all.metadata.schema.find("Intensity");
    PointFilter filter;
    filter.conditions = need(conditionsFromText("Intensity:..5000"));
    filter.box = BoxD{{500000, 4000000, 0}, {500500, 4000500, 600}};
    auto passes = [&](std::size_t i) {
        return f.all.points.value<std::uint16_t>(intensity, i) <= 5000 &&
               filter.box->contains(f.all.world(i));
    };
    for (int i = 0; i < 30; ++i) {
        f.compare(filter, DistanceRank(f.somewhere(600), false, infinity), 12, passes);
        Vec3d origin = f.somewhere(900);
        f.compare(filter, RayRank(origin, f.somewhere(300) - origin, 30, 0, infinity), 3, passes);
    }
}

TEST_CASE("hierarchy chunks are read on the way, and no more than needed") {
    SmallCloudOptions options = quarterGrid();
    options.levels = 6;
    options.pointsPerNode = 4;
    Fixture f(options);
    NearestCounters c = f.compare({}, DistanceRank(f.somewhere(100), false, infinity), 1, always);
    CHECK(c.chunksRead >= 1);
    std::uint64_t chunks =
        need(f.reader->visitWanted([](const NodeEntry&) -> Result<bool> { return true; })).chunksRead;
    REQUIRE(chunks > 2);
    CHECK(c.chunksRead < chunks);
}

TEST_CASE("a search that is stopped ends, and damage is an error") {
    Fixture f;
    CloudFilter everything = need(CloudFilter::make(f.reader->metadata(), {}));
    std::atomic<bool> stop{true};
    DistanceRank rank(f.somewhere(100), false, infinity);
    StopGate gate(&stop);
    auto stopped = nearestPoints(*f.reader, "c", everything, rank, 1, &gate);
    REQUIRE_FALSE(stopped.ok());
    CHECK(stopped.error().code == ErrorCode::cancelled);
    Bytes bytes = f.file.cloud.file;
    bytes[f.file.cloud.nodes.front().offsetBytes] ^= 0xFF;
    MemorySource damaged(bytes);
    auto reader = need(CloudReader::open(damaged));
    CHECK_FALSE(nearestPoints(*reader, "c", everything, rank, 1, nullptr).ok());
}

TEST_CASE("a cloud of no points has no nearest") {
    TemporaryFolder folder;
    writeScan(surfaceScan(1, 0, 1), folder / "in.las");
    convertOrFail({folder / "in.las"}, folder / "c.stipple");
    auto source = need(openFileSource(folder / "c.stipple"));
    auto reader = need(CloudReader::open(*source));
    CloudFilter everything = need(CloudFilter::make(reader->metadata(), {}));
    CHECK(need(nearestPoints(*reader, "c", everything, DistanceRank({}, false, infinity), 5, nullptr))
              .points.empty());
}
