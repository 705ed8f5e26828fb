#include "shared/geometry/plan_polygon.hpp"
#include "tests/unit/client/survey/random_points.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <numbers>

using namespace stipple;
using stipple::test::RandomPlaces;

namespace {

// A star: simple, and mostly not convex.
std::vector<Point2d> star(RandomPlaces& random, int n) {
    std::vector<Point2d> corners;
    for (int i = 0; i < n; ++i) {
        double turn = 2 * std::numbers::pi * (i + random.between(0, 0.8)) / n, r = random.between(0.2, 5);
        corners.push_back({r * std::cos(turn), r * std::sin(turn)});
    }
    return corners;
}

double areaOf(const std::vector<Point2d>& corners, const std::vector<Triangle>& triangles) {
    double sum = 0;
    for (const Triangle& t : triangles) {
        double part = signedArea(std::vector<Point2d>{corners[t[0]], corners[t[1]], corners[t[2]]});
        CHECK(part > 0);
        sum += part;
    }
    return sum;
}

} // namespace

TEST_CASE("triangles cover a polygon once, whichever way it runs") {
    RandomPlaces random(8);
    for (int i = 0; i < 300; ++i) {
        std::vector<Point2d> corners = star(random, static_cast<int>(random.integer(5, 30)));
        if (crossesItself(corners)) // two of a star's corners may be more than half a turn apart
            continue;
        auto triangles = triangulate(corners);
        REQUIRE(triangles.ok());
        CHECK(triangles->size() == corners.size() - 2);
        CHECK(areaOf(corners, *triangles) == Approx(std::abs(signedArea(corners))).epsilon(1e-12));
        std::reverse(corners.begin(), corners.end());
        auto again = triangulate(corners);
        REQUIRE(again.ok());
        CHECK(areaOf(corners, *again) == Approx(std::abs(signedArea(corners))).epsilon(1e-12));
    }
}

TEST_CASE("corners on straight edges are no obstacle, crossings are") {
    std::vector<Point2d> square{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
    auto triangles = triangulate(square);
    REQUIRE(triangles.ok());
    CHECK(areaOf(square, *triangles) == Approx(4));
    CHECK_FALSE(triangulate(std::vector<Point2d>{{0, 0}, {2, 2}, {2, 0}, {0, 2}}).ok());
    CHECK_FALSE(triangulate(std::vector<Point2d>{{0, 0}, {1, 1}, {2, 2}}).ok());
    CHECK_FALSE(triangulate(std::vector<Point2d>{{0, 0}, {1, 1}}).ok());
    CHECK_FALSE(triangulate({}).ok());
}

TEST_CASE("the parts of a polygon in the boxes of a grid add up to it") {
    RandomPlaces random(9);
    for (int i = 0; i < 50; ++i) {
        std::vector<Point2d> corners = star(random, 12);
        double sum = 0;
        for (int row = -6; row < 6; ++row)
            for (int column = -6; column < 6; ++column) {
                Point2d low{column * 1.0, row * 1.0}, high{column + 1.0, row + 1.0};
                double part = signedArea(clipToBox(corners, low, high));
                CHECK(std::abs(part) <= 1 + 1e-12);
                sum += part;
            }
        CHECK(sum == Approx(signedArea(corners)).epsilon(1e-12));
    }
}
