#include "shared/codec/position_codec.hpp"
#include "shared/codec/progressive_order.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>

using namespace stipple;

namespace {

// Mean distance of points of a square to their nearest neighbour.
double meanNearest(const std::vector<Vec3<std::uint32_t>>& points) {
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        double nearest = 1e30;
        for (std::size_t j = 0; j < points.size(); ++j)
            if (i != j) {
                double dx = double(points[i].x) - points[j].x, dy = double(points[i].y) - points[j].y;
                nearest = std::min(nearest, dx * dx + dy * dy);
            }
        sum += std::sqrt(nearest);
    }
    return sum / static_cast<double>(points.size());
}

} // namespace

TEST_CASE("strata are every eighth point, then those half-way, then the quarter, then the half") {
    CHECK(progressiveOrder(0).empty());
    CHECK(progressiveOrder(1) == std::vector<std::uint32_t>{0});
    CHECK(progressiveOrder(10) == std::vector<std::uint32_t>{0, 8, 4, 2, 6, 1, 9, 5, 3, 7});
}

TEST_CASE("inside a stratum the index is bit-reversed") {
    CHECK(bitReversedOrder(8) == std::vector<std::uint32_t>{0, 4, 2, 6, 1, 5, 3, 7});
    CHECK(bitReversedOrder(5) == std::vector<std::uint32_t>{0, 4, 2, 1, 3});
}

TEST_CASE("every point has one place in the progressive order") {
    for (std::uint32_t count : {2u, 3u, 7u, 8u, 9u, 1000u, 65537u}) {
        auto order = progressiveOrder(count);
        REQUIRE(order.size() == count);
        for (int strata = 1; strata <= strataCount; ++strata)
            for (std::uint32_t i = 0; i < strataPrefixPoints(count, strata); ++i)
                if (order[i] % (8u >> (strata - 1)) != 0)
                    FAIL("point " << order[i] << " comes too early");
        std::sort(order.begin(), order.end());
        for (std::uint32_t i = 0; i < count; ++i)
            if (order[i] != i)
                FAIL("point " << i << " is missing");
    }
}

TEST_CASE("a prefix is spread more evenly than a random choice") {
    std::mt19937 random(4);
    std::vector<Vec3<std::uint32_t>> points;
    for (int i = 0; i < 16000; ++i)
        points.push_back({static_cast<std::uint32_t>(random() % 100000),
                          static_cast<std::uint32_t>(random() % 100000), 0});
    SortedPoints sorted = sortPoints(points);
    auto order = progressiveOrder(16000);
    for (std::size_t count : {500u, 2000u, 3000u}) {
        std::vector<Vec3<std::uint32_t>> prefix;
        for (std::size_t r = 0; r < count; ++r)
            prefix.push_back(points[sorted.input[order[r]]]);
        double even = meanNearest(prefix),
               chance = meanNearest({points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count)});
        INFO(count << " points: " << even / chance
                   << " times the nearest-neighbour distance of a random choice");
        CHECK(even > 1.08 * chance);
    }
}
