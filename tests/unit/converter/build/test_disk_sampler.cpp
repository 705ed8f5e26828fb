#include "converter/build/disk_sampler.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace stipple;

namespace {
double squaredDistance(Vec3i a, Vec3i b, Vec3d w) {
    double dx = static_cast<double>(a.x - b.x) * w.x, dy = static_cast<double>(a.y - b.y) * w.y,
           dz = static_cast<double>(a.z - b.z) * w.z;
    return dx * dx + dy * dy + dz * dz;
}

// Throws random points and compares each answer with a search through all accepted ones.
void compareWithSearch(int nodeBits, Vec3d weights, double squared, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    DiskSampler sampler;
    for (int round = 0; round < 2; ++round) { // the second time in a used sampler
        sampler.begin(nodeBits, weights, squared);
        std::vector<Vec3i> accepted;
        std::int64_t side = std::int64_t{1} << nodeBits;
        auto margin = static_cast<std::int64_t>(std::sqrt(squared));
        for (int i = 0; i < 20; ++i) { // what neighbours have taken, just outside
            Vec3i p{-1 - static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(margin + 1)),
                    static_cast<std::int64_t>(random()) & (side - 1),
                    static_cast<std::int64_t>(random()) & (side - 1)};
            sampler.block(p);
            accepted.push_back(p);
        }
        for (int i = 0; i < 3000; ++i) {
            Vec3i p{static_cast<std::int64_t>(random()) & (side - 1),
                    static_cast<std::int64_t>(random()) & (side - 1),
                    static_cast<std::int64_t>(random() % 7) * side / 7};
            bool isFree = true;
            for (Vec3i other : accepted)
                isFree = isFree && squaredDistance(p, other, weights) >= squared;
            REQUIRE(sampler.accept(p) == isFree);
            if (isFree)
                accepted.push_back(p);
        }
    }
}
} // namespace

TEST_CASE("a point is accepted exactly if none accepted is nearer than the distance", "[sample]") {
    compareWithSearch(10, {1, 1, 1}, 40 * 40, 1);
    compareWithSearch(20, {1, 1, 1}, 12345.0 * 12345.0, 2);
    compareWithSearch(31, {1, 1, 1}, 3e7 * 3e7, 3);
}

TEST_CASE("distances follow the weights of the axes", "[sample]") {
    compareWithSearch(10, {1, 1, 0.1}, 40 * 40, 4);
    compareWithSearch(10, {1, 1, 10}, 40 * 40, 5);
    compareWithSearch(10, {1, 1, 0}, 20 * 20, 6);
}

TEST_CASE("distances below one step part duplicates only", "[sample]") {
    compareWithSearch(3, {1, 1, 1}, 0.01, 7);
    DiskSampler sampler;
    sampler.begin(0, {1, 1, 1}, 1e-6);
    CHECK(sampler.accept({0, 0, 0}));
    CHECK_FALSE(sampler.accept({0, 0, 0}));
}

TEST_CASE("distances wider than the node leave one point", "[sample]") {
    compareWithSearch(5, {1, 1, 1}, 100 * 100, 8);
}
