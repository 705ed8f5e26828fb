#include "converter/input/common_grid.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

namespace {
Grid uniform(double scale, double offset) {
    return {{scale, scale, scale}, {offset, offset, offset}};
}
} // namespace

TEST_CASE("one grid stays as it is", "[grid]") {
    Grid grid = uniform(0.000304800609601, 12345.6789);
    CHECK(commonGrid({grid, grid}) == grid);
    CHECK(gridMap(grid, grid).isIdentity());
}

TEST_CASE("grids of two scales meet on the finer one", "[grid]") {
    Grid coarse = uniform(0.01, 500000), fine = uniform(0.001, 500000);
    Grid common = commonGrid({coarse, fine});
    CHECK(common == fine);
    GridMap map = gridMap(coarse, common);
    CHECK(map.isExact());
    CHECK(map.toCloud({1, -2, 3}) == Vec3i{10, -20, 30});
}

TEST_CASE("scales that do not divide each other meet on their greatest common divisor", "[grid]") {
    Grid a = uniform(0.01, 0), b = uniform(0.025, 0);
    Grid common = commonGrid({a, b});
    CHECK(common.scale == Vec3d{0.005, 0.005, 0.005});
    CHECK(gridMap(a, common).toCloud({1, 1, 1}) == Vec3i{2, 2, 2});
    CHECK(gridMap(b, common).toCloud({1, 1, 1}) == Vec3i{5, 5, 5});
}

TEST_CASE("offsets off each other's grid refine it", "[grid]") {
    Grid a = uniform(0.01, 100), b = uniform(0.01, 200.005);
    Grid common = commonGrid({a, b});
    CHECK(common.scale.x == 0.005);
    CHECK(common.offset.x == 100);
    GridMap map = gridMap(b, common);
    CHECK(map.isExact());
    CHECK(map.toCloud({0, 0, 0}).x == 20001);
}

TEST_CASE("the common grid does not depend on the order of the inputs", "[grid]") {
    Grid a = uniform(0.01, 1000), b = uniform(0.002, -40), c = uniform(0.05, 3.5);
    CHECK(commonGrid({a, b, c}) == commonGrid({c, a, b}));
    CHECK(commonGrid({a, b, c}) == commonGrid({b, c, a}));
}

TEST_CASE("offsets with stray digits are rounded to the finest scale, and the error is told", "[grid]") {
    Grid a = uniform(0.01, 0), b = uniform(0.01, 637012.2399999);
    Grid common = commonGrid({a, b});
    CHECK(common.scale.x == 0.01);
    AxisMap axis = gridMap(b, common).axes[0];
    CHECK_FALSE(axis.exact);
    CHECK(axis.toCloud(1) == 63701225);
    CHECK(axis.errorSteps(1) == Approx(0.00001).epsilon(0.01));
}

TEST_CASE("each axis has a grid of its own", "[grid]") {
    Grid a{{1e-7, 1e-7, 0.01}, {-93, 41, 0}}, b{{1e-7, 1e-7, 0.001}, {-93, 41, 0}};
    Grid common = commonGrid({a, b});
    CHECK(common.scale == Vec3d{1e-7, 1e-7, 0.001});
    CHECK(gridMap(a, common).isExact());
}
