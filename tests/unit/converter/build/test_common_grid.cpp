#include "converter/input/common_grid.hpp"

#include "converter/input/float_grid.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

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

TEST_CASE("an offset of -0 is 0, whichever input has it", "[grid]") {
    Grid negative = uniform(0.01, -0.0), positive = uniform(0.01, 0.0), fine = uniform(0.001, -0.0);
    for (const Grid& grid : {commonGrid({negative}), commonGrid({negative, positive}),
                             commonGrid({positive, fine}), commonGrid({fine, positive})})
        for (int axis = 0; axis < 3; ++axis)
            CHECK_FALSE(std::signbit(grid.offset[axis]));
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

TEST_CASE("three scales meet on the finest", "[grid]") {
    std::vector<Grid> grids{uniform(0.001, 1000), uniform(0.01, 2000), uniform(0.0001, -500)};
    Grid common = commonGrid(grids);
    CHECK(common == uniform(0.0001, -500));
    CHECK(gridMap(grids[0], common).toCloud({1, 2, 3}) == Vec3i{15000010, 15000020, 15000030});
    CHECK(gridMap(grids[1], common).toCloud({-1, 0, 1}) == Vec3i{24999900, 25000000, 25000100});
    CHECK(gridMap(grids[2], common).isIdentity());
}

TEST_CASE("feet and metres meet exactly where both are decimals", "[grid]") {
    Grid metres = uniform(0.01, 0), feet = uniform(0.003048, 0); // 0.01 ft
    Grid common = commonGrid({metres, feet});
    CHECK(common.scale.x == 0.000008);
    CHECK(gridMap(metres, common).toCloud({1, 1, 1}).x == 1250);
    CHECK(gridMap(feet, common).toCloud({1, 1, 1}).x == 381);
}

TEST_CASE("US survey feet and metres meet on the finer scale, and the error is told", "[grid]") {
    Grid metres = uniform(0.001, 0), feet = uniform(0.000304800609601, 0);
    Grid common = commonGrid({metres, feet});
    CHECK(common.scale.x == 0.000304800609601);
    AxisMap axis = gridMap(metres, common).axes[0];
    CHECK_FALSE(axis.exact);
    double largest = 0;
    for (std::int64_t i = 0; i < 1000; ++i) {
        largest = std::max(largest, axis.errorSteps(i));
        double moved = std::abs(0.000304800609601 * static_cast<double>(axis.toCloud(i)) -
                                0.001 * static_cast<double>(i));
        CHECK(moved == Approx(axis.errorSteps(i) * 0.000304800609601).margin(1e-12));
    }
    CHECK(largest > 0.49);
    CHECK(largest <= 0.5);
    CHECK(gridMap(feet, common).isExact());
}

TEST_CASE("the extremes of LAS's integers come through exactly", "[grid]") {
    Grid fine = uniform(0.001, 0), coarse = uniform(0.01, 4500000);
    Grid common = commonGrid({fine, coarse});
    constexpr std::int64_t low = std::numeric_limits<std::int32_t>::min(),
                           high = std::numeric_limits<std::int32_t>::max();
    GridMap map = gridMap(coarse, common);
    REQUIRE(map.isExact());
    CHECK(map.toCloud({low, 0, high}) == Vec3i{10 * low + 4500000000, 4500000000, 10 * high + 4500000000});
}

TEST_CASE("a cloud 2^52 steps wide keeps its grid when a scan joins it", "[grid]") {
    constexpr std::int64_t wide = (std::int64_t{1} << 52) - 1;
    Grid cloud = uniform(1e-6, 0), scan = uniform(0.01, 100), finer = uniform(1e-9, 0);
    BoxI cloudBox{{0, 0, 0}, {wide, wide, wide}}, scanBox{{0, 0, 0}, {5000, 5000, 5000}};
    Grid common = commonGrid({cloud, scan}, {cloudBox, scanBox});
    CHECK(common == cloud);
    CHECK(gridMap(scan, common).toCloud({1, 1, 1}).x == 100010000);
    CHECK(gridMap(cloud, common).isIdentity());
    // A common grid of 1e-9 would be 2^62 steps wide: the finer scan is rounded.
    common = commonGrid({cloud, finer}, {cloudBox, scanBox});
    CHECK(common == cloud);
    CHECK(gridMap(cloud, common).isIdentity());
    AxisMap axis = gridMap(finer, common).axes[0];
    CHECK_FALSE(axis.exact);
    CHECK(axis.toCloud(1400) == 1);
    CHECK(axis.errorSteps(1400) == Approx(0.4));
    // Without knowing where points lie, the exact grid is taken.
    CHECK(commonGrid({cloud, finer}).scale.x == 1e-9);
}

TEST_CASE("scans far from each other with fine grids fit one cloud", "[grid]") {
    Grid here = uniform(1e-9, 0), there = uniform(1e-9, 2e7);
    BoxI box{{0, 0, 0}, {2000000000, 2000000000, 2000000000}};
    Grid common = commonGrid({here, there}, {box, box});
    CHECK(common.scale.x == 1e-8); // 2e16 steps of 1e-9 are too many
    for (const Grid& grid : {here, there})
        for (int axis = 0; axis < 3; ++axis)
            CHECK(gridMap(grid, common).toCloud(box.max)[axis] < std::int64_t{1} << 52);
    CHECK(commonGrid({there, here}, {box, box}) == common);
}

TEST_CASE("integers that nothing can hold stay defined", "[grid]") {
    AxisMap axis;
    axis.multiply = 1000;
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
    CHECK(axis.toCloud(most / 2) > std::int64_t{1} << 60);
    CHECK(axis.toCloud(-most / 2) < -(std::int64_t{1} << 60));
}

TEST_CASE("grids of floating-point inputs meet those of LAS exactly", "[grid]") {
    BoxD site;
    site.extend(Vec3d{637012.5, 848900.25, 400});
    site.extend(Vec3d{638000, 850000, 600});
    Grid las{{0.01, 0.01, 0.001}, {600000, 800000, 0}};
    for (Precision precision : {Precision{-1, 24}, Precision{-1, 53}, Precision{3, 53}}) {
        Grid floats = floatGrid(site, precision);
        Grid common = commonGrid({las, floats});
        CAPTURE(floats.scale.x, floats.offset.x, common.scale.x);
        CHECK(gridMap(las, common).isExact());
        CHECK(gridMap(floats, common).isExact());
    }
}
