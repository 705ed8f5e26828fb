#include "shared/geometry/oriented_box.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace stipple;

namespace {

ConvexRegion box(Vec3d centre, Vec3d size, const BoxAxes& axes, bool anyHeight = false) {
    auto made = orientedBox(centre, size, axes, anyHeight);
    if (!made)
        FAIL(made.error().sentence());
    return *std::move(made);
}

void checkAxes(const BoxAxes& a, const BoxAxes& b) {
    for (std::size_t i = 0; i < 3; ++i)
        for (int axis = 0; axis < 3; ++axis)
            CHECK(a[i][axis] == Approx(b[i][axis]).margin(1e-15));
}

} // namespace

TEST_CASE("a turned box lies counter-clockwise") {
    // Long along x, turned to the north-west.
    ConvexRegion region = box({100, 200, 0}, {10, 2, 4}, axesTurned(135));
    Vec3d along{-std::sqrt(0.5), std::sqrt(0.5), 0};
    CHECK(region.contains(Vec3d{100, 200, 0} + along * 4.9));
    CHECK_FALSE(region.contains(Vec3d{100, 200, 0} + along * 5.1));
    CHECK_FALSE(region.contains(Vec3d{100, 200, 0} + Vec3d{along.y, -along.x, 0} * 1.1));
    CHECK_FALSE(region.contains({104, 200, 0}));
    CHECK(region.contains({100, 200, 2}));
    CHECK_FALSE(region.contains({100, 200, 2.1}));
}

TEST_CASE("turns by right angles have no rounding, wherever the box lies") {
    for (double turn : {0.0, 90.0, -90.0, 180.0, -180.0, 270.0, 360.0, 450.0, -630.0}) {
        INFO(turn);
        bool across = std::fmod(std::abs(turn), 180) == 90;
        ConvexRegion region = box({500000.25, 4000000.5, 10}, {30, 8, 1}, axesTurned(turn));
        double x = across ? 4 : 15, y = across ? 15 : 4;
        for (double sx : {-1.0, 1.0})
            for (double sy : {-1.0, 1.0}) {
                Vec3d corner{500000.25 + sx * x, 4000000.5 + sy * y, 9.5};
                CHECK(region.contains(corner));
                CHECK_FALSE(region.contains({std::nextafter(corner.x, sx * 1e9), corner.y, corner.z}));
                CHECK_FALSE(region.contains({corner.x, std::nextafter(corner.y, sy * 1e9), corner.z}));
            }
    }
}

TEST_CASE("quaternions turn as angles do") {
    for (double degrees : {0.0, 30.0, 135.0, -80.0}) {
        double half = degrees * 3.14159265358979323846 / 360;
        for (double scale : {1.0, 1e-200, -3e150}) {
            auto axes = axesOfQuaternion(0, 0, scale * std::sin(half), scale * std::cos(half));
            REQUIRE(axes);
            checkAxes(*axes, axesTurned(degrees));
        }
    }
    // A quarter turn about x takes y to z.
    auto axes = axesOfQuaternion(1, 0, 0, 1);
    REQUIRE(axes);
    checkAxes(*axes, {Vec3d{1, 0, 0}, Vec3d{0, 0, 1}, Vec3d{0, -1, 0}});
    CHECK_FALSE(axesOfQuaternion(0, 0, 0, 0));
    CHECK_FALSE(axesOfQuaternion(NAN, 0, 0, 1));
    CHECK_FALSE(axesOfQuaternion(0, INFINITY, 0, 1));
}

TEST_CASE("a box without heights is endless along z") {
    ConvexRegion region = box({10, 10, NAN}, {4, 2, NAN}, axesTurned(45), true);
    CHECK(region.contains({11, 11, 1e9}));
    CHECK(region.contains({11, 11, -1e9}));
    CHECK_FALSE(region.contains({12, 12, 0}));
    CHECK(region.overlapOf({{10, 10, -1e6}, {10.1, 10.1, 1e6}}) == Overlap::whole);
}

TEST_CASE("what is said of a box holds for its points, and bounds hold every one") {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    int whole = 0, none = 0;
    for (int i = 0; i < 400; ++i) {
        auto axes = axesOfQuaternion(unit(random), unit(random), unit(random), unit(random));
        REQUIRE(axes);
        Vec3d centre{500000 + 10 * unit(random), 4000000 + 10 * unit(random), 10 * unit(random)};
        ConvexRegion region =
            box(centre, {4 + 3 * unit(random), 8 + 3 * unit(random), 9 + 3 * unit(random)}, *axes);
        for (int b = 0; b < 20; ++b) {
            BoxD part;
            Vec3d corner = centre + Vec3d{unit(random), unit(random), unit(random)} * 8;
            part.extend(corner);
            part.extend(corner + Vec3d{unit(random), unit(random), unit(random)} * 3);
            Overlap overlap = region.overlapOf(part);
            whole += overlap == Overlap::whole;
            none += overlap == Overlap::none;
            for (int s = 0; s < 20; ++s) {
                Vec3d p;
                for (int axis = 0; axis < 3; ++axis)
                    p[axis] = part.min[axis] + (unit(random) + 1) / 2 * (part.max[axis] - part.min[axis]);
                bool in = region.contains(p);
                REQUIRE_FALSE((overlap == Overlap::whole && !in));
                REQUIRE_FALSE((overlap == Overlap::none && in));
                REQUIRE((!in || region.bounds().contains(p)));
            }
        }
    }
    CHECK(whole > 100);
    CHECK(none > 2000);
}

TEST_CASE("boxes that are none are refused") {
    CHECK_FALSE(orientedBox({NAN, 0, 0}, {1, 1, 1}, axesTurned(0), false).ok());
    CHECK_FALSE(orientedBox({0, 0, 0}, {1, -1, 1}, axesTurned(0), false).ok());
    CHECK_FALSE(orientedBox({0, 0, 1e101}, {1, 1, 1}, axesTurned(0), false).ok());
    CHECK_FALSE(orientedBox({0, 0, 0}, {1, INFINITY, 1}, axesTurned(0), false).ok());
    CHECK(orientedBox({0, 0, 0}, {0, 0, 0}, axesTurned(0), false).ok()); // a point
}
