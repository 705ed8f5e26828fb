#include "client/survey/circles.hpp"
#include "tests/unit/client/survey/random_points.hpp"

#include <catch2/catch.hpp>

#include <numbers>

using namespace stipple;
using namespace stipple::survey;
using stipple::test::RandomPlaces;

TEST_CASE("three points of a circle give it back", "[numerics]") {
    RandomPlaces random(7);
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
        Vec3d normal = random.unit(), u = normalized(cross(normal, random.unit())), v = cross(normal, u);
        double radius = random.between(0.01, 100), turn = random.between(0, 6);
        Vec3d centre = u * random.between(-9, 9);
        auto at = [&](double angle) {
            return centre + u * (radius * std::cos(angle)) + v * (radius * std::sin(angle));
        };
        auto circle =
            circleThrough(at(turn), at(turn + random.between(0.5, 2)), at(turn + random.between(2.5, 5)));
        REQUIRE(circle.ok());
        worst = std::max(worst, std::abs(circle->radius / radius - 1));
        CHECK(length(circle->centre - centre) < 1e-10 * (1 + radius));
        CHECK(length(cross(circle->normal, normal)) < 1e-10);
    }
    CHECK(worst < 1e-11); // of the points' own rounding, some 9 away with a radius of 0.01
}

TEST_CASE("no circle goes through points on one line") {
    auto line = circleThrough({0, 0, 0}, {1, 1, 1}, {3, 3, 3});
    REQUIRE_FALSE(line.ok());
    CHECK(line.error().code == ErrorCode::invalidArgument);
    CHECK_FALSE(circleThrough({1, 2, 3}, {1, 2, 3}, {4, 5, 6}).ok());
    CHECK_FALSE(circleThrough({1, 2, 3}, {1, 2, 3}, {1, 2, 3}).ok());
    auto flat = circleThrough({-1, 0, 0}, {0, 1e-6, 0}, {1, 0, 0}); // large, but one
    REQUIRE(flat.ok());
    CHECK(flat->radius == Approx(5e5).epsilon(1e-6));
}
