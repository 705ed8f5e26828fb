#include "converter/build/disk_sampler.hpp"
#include "converter/build/disk_thinning.hpp"
#include "converter/build/morton.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

using namespace stipple;

namespace {
using Points = std::vector<Vec3<std::uint32_t>>;

Vec3i wide(Vec3<std::uint32_t> p) {
    return {p.x, p.y, p.z};
}

Points randomPoints(int nodeBits, std::size_t count, std::mt19937_64& random) {
    const std::uint64_t side = std::uint64_t{1} << nodeBits;
    Points points(count);
    for (auto& p : points)
        p = {static_cast<std::uint32_t>(random() % side), static_cast<std::uint32_t>(random() % side),
             static_cast<std::uint32_t>(random() % 7 * side / 7)};
    return points;
}

void sortByMorton(Points& points) {
    std::sort(points.begin(), points.end(),
              [](auto a, auto b) { return compareMorton(wide(a), wide(b)) < 0; });
}

// Takes points in a random order and compares each answer with the point-by-point sampler's.
void compareWithSampler(DiskThinning& thinning, int nodeBits, Vec3d weights, double squared,
                        const Points& points, std::mt19937_64& random) {
    DiskSampler sampler;
    sampler.begin(nodeBits, weights, squared);
    thinning.begin(nodeBits, weights, squared, points);
    const std::int64_t side = std::int64_t{1} << nodeBits;
    const auto margin = static_cast<std::uint64_t>(std::sqrt(squared));
    // What neighbours have taken, just outside; beside narrow nodes that would leave nothing.
    for (int i = 0; i < 20 && margin < static_cast<std::uint64_t>(side); ++i) {
        auto out = static_cast<std::int64_t>(random() % (margin + 1)),
             along = static_cast<std::int64_t>(random());
        Vec3i p = i % 2 == 0 ? Vec3i{-1 - out, along & (side - 1), along >> 32 & (side - 1)}
                             : Vec3i{along & (side - 1), along >> 32 & (side - 1), side + out};
        sampler.block(p);
        thinning.exclude(p, DiskThinning::outside);
    }
    std::vector<std::size_t> order(points.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = i;
    std::shuffle(order.begin(), order.end(), random);
    std::size_t taken = 0;
    for (std::size_t i : order) {
        bool isFree = thinning.isFree(i);
        REQUIRE(sampler.accept(wide(points[i])) == isFree);
        if (isFree)
            thinning.exclude(wide(points[i]), static_cast<std::uint32_t>(i));
        taken += isFree ? 1 : 0;
    }
    CHECK(taken > 0);
}

void compareInRandomNodes(int nodeBits, Vec3d weights, double squared, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    DiskThinning thinning;
    for (std::size_t count : {3001u, 3000u, 17u}) { // from the second on it has been used
        Points points = randomPoints(nodeBits, count, random);
        compareWithSampler(thinning, nodeBits, weights, squared, points, random); // in no order
        sortByMorton(points);
        compareWithSampler(thinning, nodeBits, weights, squared, points, random);
    }
}
} // namespace

TEST_CASE("what exclusion leaves free is what the sampler accepts", "[sample]") {
    compareInRandomNodes(10, {1, 1, 1}, 40 * 40, 1);
    compareInRandomNodes(20, {1, 1, 1}, 12345.0 * 12345.0, 2);
    compareInRandomNodes(31, {1, 1, 1}, 3e7 * 3e7, 3);
    compareInRandomNodes(31, {1, 1, 1}, std::ldexp(1.0, 62 - 16), 4);
}

TEST_CASE("exclusion follows the weights of the axes", "[sample]") {
    for (double z : {0.0, 0.01, 0.1, 10.0, 100.0}) {
        compareInRandomNodes(10, {1, 1, z}, 40 * 40, 5);
        compareInRandomNodes(20, {0.3, 1, z}, 1e4 * 1e4, 6);
    }
}

TEST_CASE("exclusion parts duplicates only below one step, and leaves one point in a narrow node",
          "[sample]") {
    compareInRandomNodes(3, {1, 1, 1}, 0.01, 7);
    compareInRandomNodes(0, {1, 1, 1}, 1e-6, 8);
    compareInRandomNodes(5, {1, 1, 1}, 100 * 100, 9);
}

TEST_CASE("points at the distance itself stay, those a step nearer go, where floats can't tell", "[sample]") {
    // 2^31 steps: a float holds every 128th of them.
    constexpr std::uint32_t corner = (std::uint32_t{1} << 30) + 12345;
    constexpr std::uint32_t across = 3u << 22, along = 4u << 22, distance = 5u << 22;
    const Points points{{corner, corner, corner},
                        {corner + across, corner + along, corner},
                        {corner + across - 1, corner + along, corner},
                        {corner, corner - across, corner - along},
                        {corner, corner - across, corner - along + 1},
                        {corner, corner, corner + distance},
                        {corner, corner, corner + distance - 1}};
    DiskThinning thinning;
    thinning.begin(31, {1, 1, 1}, double{distance} * distance, points);
    thinning.exclude(wide(points[0]), 0);
    for (std::size_t i = 0; i < points.size(); ++i)
        CHECK(thinning.isFree(i) == (i % 2 == 1));
}

TEST_CASE("a node without points has nothing to exclude", "[sample]") {
    DiskThinning thinning;
    thinning.begin(10, {1, 1, 1}, 100, {});
    thinning.exclude({5, 5, 5}, DiskThinning::outside);
    const Points one{{1, 1, 1}};
    thinning.begin(10, {1, 1, 1}, 100, one);
    CHECK(thinning.isFree(0));
}

TEST_CASE("of those that exclude a point the nearest is known, an outside one only if it is alone",
          "[sample]") {
    const Points points{{100, 100, 0}, {109, 100, 0}, {104, 100, 0}, {92, 100, 0}, {0, 5, 0}, {300, 300, 0}};
    for (bool reversed : {false, true}) {
        DiskThinning thinning;
        thinning.begin(10, {1, 1, 1}, 81, points); // 9 steps
        thinning.exclude({-1, 5, 0}, DiskThinning::outside);
        thinning.exclude({103, 101, 0}, DiskThinning::outside); // nearest to the third
        thinning.exclude(wide(points[reversed ? 1 : 0]), reversed ? 1 : 0);
        thinning.exclude(wide(points[reversed ? 0 : 1]), reversed ? 0 : 1);
        CHECK(thinning.excludedBy(0) == 0);
        CHECK(thinning.excludedBy(1) == 1);
        CHECK(thinning.excludedBy(2) == 0); // 4 steps, 5 to the other
        CHECK(thinning.excludedBy(3) == 0);
        CHECK(thinning.excludedBy(4) == DiskThinning::outside);
        CHECK(thinning.isFree(5));
    }
}
