#include "converter/input/float_grid.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>

using namespace stipple;

namespace {
BoxD boxOf(Vec3d low, Vec3d high) {
    BoxD box;
    box.extend(low);
    box.extend(high);
    return box;
}
} // namespace

TEST_CASE("decimals give the step") {
    Grid grid = floatGrid(boxOf({0, 0, 0}, {100, 100, 10}), {3});
    CHECK(grid.scale == Vec3d{0.001, 0.001, 0.001});
    CHECK(grid.offset == Vec3d{0, 0, 0});
    CHECK(floatGrid(boxOf({0, 0, 0}, {1, 1, 1}), {0}).scale.x == 1);
}

TEST_CASE("far from the origin the offset is near the centre and a multiple of the step") {
    Grid grid = floatGrid(boxOf({2893000, 1000, 0}, {2894000, 1500, 100}), {4});
    CHECK(grid.offset.x == 2893500);
    CHECK(grid.offset.y == 0);
    CHECK(std::abs((2893000 - grid.offset.x) / grid.scale.x) < 2147483648.0);
}

TEST_CASE("float32 coordinates are read back as the same float32 wherever they are largest") {
    std::mt19937 random(5);
    for (double magnitude : {0.001, 0.19, 1.0, 99.0, 12345.0, 3e6}) {
        Grid grid = floatGrid(boxOf({-magnitude, 0, 0}, {magnitude, magnitude, 0}), {-1, 24});
        CHECK(2 * magnitude / grid.scale.x <= 2147483648.0);
        for (int i = 0; i < 1000; ++i) {
            // Of the numbers that are as far apart as the largest.
            double low = std::ldexp(1.0, std::ilogb(magnitude));
            double part = static_cast<double>(random() >> 8) / (1 << 24);
            float value = static_cast<float>(low + (magnitude - low) * part);
            double steps = std::round((static_cast<double>(value) - grid.offset.x) / grid.scale.x);
            REQUIRE(static_cast<float>(grid.offset.x + steps * grid.scale.x) == value);
        }
    }
}

TEST_CASE("a grid is never wider than nodes can hold points, but for a step that was asked for") {
    BoxD wide = boxOf({0, 0, 0}, {1e7, 1e7, 100});
    CHECK(floatGrid(wide, {9}).scale.x == 0.001); // 2^33 steps; 0.0001 would be 2^36.5
    CHECK(floatGrid(wide, {9, 24}).scale.x == 0.01);
    CHECK(floatGrid(wide, {9}, 1e-6).scale.x == 1e-6);
    CHECK(floatGrid(wide, {9}, 1e-12).scale.x > 1e-9); // 2^53 steps from zero
    CHECK(floatGrid(boxOf({0, 0, 0}, {100, 100, 100}), {-1, 53}).scale.x == 1e-7);
}

TEST_CASE("no points and one point have a grid") {
    CHECK(floatGrid(BoxD{}, {3}).scale.x > 0);
    CHECK(floatGrid(boxOf({5, 5, 5}, {5, 5, 5}), {-1, 24}).scale.x > 0);
    CHECK(floatGrid(boxOf({0, 0, 0}, {0, 0, 0}), {-1, 53}).scale.x == 0.001);
    CHECK(floatGrid(boxOf({0, 0, 0}, {4.9e-324, 0, 0}), {-1, 53}).scale.x == 1e-30);
    Grid far = floatGrid(boxOf({largestCoordinate, 0, 0}, {largestCoordinate, 0, 0}), {20});
    CHECK(largestCoordinate / far.scale.x <= 9007199254740992.0);
}
