#include "client/survey/directions.hpp"
#include "tests/unit/client/survey/random_points.hpp"

#include <catch2/catch.hpp>

#include <numbers>

using namespace stipple;
using namespace stipple::survey;
using stipple::test::RandomPlaces;

TEST_CASE("geocentric up is the ellipsoid's normal at any height, and north leads along the meridian",
          "[numerics]") {
    RandomPlaces random(4);
    double f = 1 / 298.257223563, e2 = f * (2 - f);
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
        double latitude = random.between(-1.57, 1.57), longitude = random.between(-3.1, 3.1);
        double height = random.between(-11000, 9000);
        double s = std::sin(latitude), c = std::cos(latitude), n = 6378137.0 / std::sqrt(1 - e2 * s * s);
        Vec3d place{(n + height) * c * std::cos(longitude), (n + height) * c * std::sin(longitude),
                    (n * (1 - e2) + height) * s};
        Vec3d up{c * std::cos(longitude), c * std::sin(longitude), s};
        Directions directions = geocentricDirections(place);
        worst = std::max(worst, length(directions.up - up));
        CHECK(std::abs(dot(directions.up, directions.north)) < 1e-15);
        CHECK(length(directions.north) == Approx(1).epsilon(1e-15));
        CHECK(directions.north.z >= 0);
        // East: the way of growing longitude.
        Vec3d east{-std::sin(longitude), std::cos(longitude), 0};
        CHECK(length(directions.east() - east) < 1e-14);
    }
    CHECK(worst < 1e-14);
}

TEST_CASE("poles and the axes have directions, too") {
    CHECK(length(geocentricDirections({0, 0, 6356752.3}).up - Vec3d{0, 0, 1}) < 1e-15);
    CHECK(length(geocentricDirections({0, 0, -6356752.3}).up - Vec3d{0, 0, -1}) < 1e-15);
    CHECK(length(geocentricDirections({6378137, 0, 0}).north - Vec3d{0, 0, 1}) < 1e-15);
    Directions projected;
    CHECK(projected.east() == Vec3d{1, 0, 0});
    CHECK(projected.height({1, 2, 3}) == 3);
}
