#include "client/survey/areas.hpp"
#include "client/survey/lines.hpp"
#include "client/survey/uncertainty.hpp"
#include "tests/unit/client/survey/random_points.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::survey;
using stipple::test::RandomPlaces;

TEST_CASE("a distance is as uncertain as its ends, along itself") {
    std::vector<Vec3d> points{{0, 0, 0}, {30, 40, 0}};
    std::vector<double> deviations{0.03, 0.04};
    auto distance = [](std::span<const Vec3d> at) { return measureLine(at).distance; };
    CHECK(uncertaintyOf(distance, points, deviations) == Approx(0.05).epsilon(1e-6));
    auto height = [](std::span<const Vec3d> at) { return measureLine(at).vertical; };
    CHECK(uncertaintyOf(height, points, deviations) == Approx(0.05).epsilon(1e-12));
    CHECK(uncertaintyOf(distance, points, std::vector<double>{0, 0}) == 0);
}

TEST_CASE("what is foretold of an area is what moved corners show") {
    std::vector<Vec3d> corners{{0, 0, 0}, {20, 0, 1}, {25, 15, 2}, {5, 12, 0}};
    double deviation = deviationOfSpacing(0.5);
    auto area = [](std::span<const Vec3d> at) { return measureArea(at).horizontal; };
    double foretold = uncertaintyOf(area, corners, std::vector<double>(4, deviation));
    RandomPlaces random(10);
    double sum = 0, squares = 0;
    constexpr int tries = 20000;
    for (int i = 0; i < tries; ++i) {
        std::vector<Vec3d> moved = corners;
        for (Vec3d& corner : moved)
            corner = corner + Vec3d{random.between(-0.25, 0.25), random.between(-0.25, 0.25),
                                    random.between(-0.25, 0.25)};
        double off = area(moved) - area(corners);
        sum += off;
        squares += off * off;
    }
    double seen = std::sqrt(squares / tries - sum / tries * sum / tries);
    CHECK(foretold == Approx(seen).epsilon(0.03));
}
