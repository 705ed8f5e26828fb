// Volumes of shapes that have a formula, from random points on them.
#include "client/survey/volumes.hpp"
#include "tests/unit/client/survey/random_points.hpp"

#include <catch2/catch.hpp>

#include <numbers>

using namespace stipple;
using namespace stipple::survey;
using stipple::test::RandomPlaces;

namespace {

const std::vector<Vec3d> square{{0, 0, 0}, {20, 0, 0}, {20, 20, 0}, {0, 20, 0}};

template <class Height>
CutFill measured(const std::vector<Vec3d>& corners, Base base, double cell, int points,
                 const Height& height) {
    auto measure = CutFillMeasure::make(corners, std::move(base), cell);
    REQUIRE(measure.ok());
    RandomPlaces random(11);
    for (int i = 0; i < points; ++i) {
        double x = random.between(-5, 25), y = random.between(-5, 25);
        measure->add({x, y, height(x, y)});
    }
    auto result = measure->result();
    REQUIRE(result.ok());
    return *result;
}

} // namespace

TEST_CASE("a cone above a plane, and below it") {
    auto cone = [](double x, double y) { return std::max(0.0, 6 - std::hypot(x - 10, y - 10)); };
    double truth = std::numbers::pi * 36 * 6 / 3;
    CutFill heap = measured(square, *Base::plane({{0, 0, 0}, {0, 0, 1}}), 0.25, 400000, cone);
    CHECK(heap.cut == Approx(truth).epsilon(0.002));
    CHECK(heap.fill == Approx(0).margin(1e-9));
    CHECK(heap.area == Approx(400).epsilon(1e-12));
    CHECK(std::abs(heap.cut - truth) < 4 * heap.deviation + 1e-3 * truth);
    CutFill pit = measured(square, *Base::plane({{0, 0, 0}, {0, 0, 1}}), 0.25, 400000,
                           [&](double x, double y) { return -cone(x, y); });
    CHECK(pit.fill == Approx(truth).epsilon(0.002));
    CHECK(pit.net() == Approx(-truth).epsilon(0.002));
    CutFill half = measured(square, *Base::plane({{0, 0, 3}, {0, 0, 1}}), 0.25, 400000, cone);
    double top = std::numbers::pi * 9 * 3 / 3; // the cone's upper half
    CHECK(half.cut == Approx(top).epsilon(0.01));
    CHECK(half.net() == Approx(truth - 3 * 400).epsilon(0.001));
}

TEST_CASE("a slope has no volume above a base of the same slope, exactly") {
    auto slope = [](double x, double y) { return 0.3 * x - 0.2 * y + 7; };
    std::vector<Vec3d> corners;
    for (Vec3d corner : square)
        corners.push_back({corner.x, corner.y, slope(corner.x, corner.y)});
    auto rim = Base::rim(corners);
    REQUIRE(rim.ok());
    CutFill flat = measured(corners, *rim, 1, 20000, slope);
    CHECK(flat.cut < 1e-11);
    CHECK(flat.fill < 1e-11);
    CutFill byPlane = measured(corners, *Base::plane(bestFitPlane(corners)), 1, 20000, slope);
    CHECK(byPlane.cut + byPlane.fill < 1e-11);
}

TEST_CASE("a rim that is not flat is spanned by triangles") {
    // A tent: its ridge from (0, 10) to (20, 10), 4 high; the ground is level.
    std::vector<Vec3d> corners{{0, 0, 0}, {20, 0, 0}, {20, 10, 4}, {20, 20, 0}, {0, 20, 0}, {0, 10, 4}};
    auto rim = Base::rim(corners);
    REQUIRE(rim.ok());
    CHECK(rim->heightAt({5, 10}) == Approx(4));
    CHECK(rim->heightAt({5, 5}) == Approx(2));
    CutFill tent = measured(corners, *rim, 0.5, 100000, [](double, double) { return 0.0; });
    CHECK(tent.fill == Approx(0.5 * 20 * 4 * 20).epsilon(1e-3));
    CHECK(tent.cut == 0);
}

TEST_CASE("what a support of the base does to cut and fill is told") {
    // Half of it above the base, half below; a base one higher anywhere by one corner's share.
    std::vector<Vec3d> corners{{0, 0, 1}, {20, 0, 0}, {20, 20, 2}, {0, 20, 0}};
    auto ground = [](double x, double) { return x < 10 ? 10.0 : -10.0; };
    CutFill before = measured(corners, *Base::rim(corners), 0.5, 50000, ground);
    double shares = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        std::vector<Vec3d> raised = corners;
        raised[i].z += 1;
        CutFill after = measured(raised, *Base::rim(raised), 0.5, 50000, ground);
        CHECK(before.cut - after.cut == Approx(before.cutShares[i]).margin(0.5));
        CHECK(after.fill - before.fill == Approx(before.fillShares[i]).margin(0.5));
        shares += before.cutShares[i] + before.fillShares[i];
    }
    CHECK(shares == Approx(before.area).epsilon(1e-9));
    CHECK(std::hypot(before.cutDeviation, before.fillDeviation) == Approx(before.deviation));
    CutFill level = measured(corners, *Base::plane({{0, 0, 0}, {0, 0, 1}}), 0.5, 50000, ground);
    REQUIRE(level.cutShares.size() == 1);
    CHECK(level.cutShares[0] + level.fillShares[0] == Approx(level.area).epsilon(1e-9));
}

TEST_CASE("polygons of any shape are cut at their edges, and holes in the scan are filled and said") {
    std::vector<Vec3d> arrow{{1, 1, 0}, {19, 2, 0}, {10, 6, 0}, {15, 19, 0}};
    double area = measureArea(arrow).horizontal;
    CutFill slab = measured(arrow, *Base::plane({{0, 0, 0}, {0, 0, 1}}), 0.7, 100000,
                            [](double, double) { return 2.5; });
    CHECK(slab.area == Approx(area).epsilon(1e-12));
    CHECK(slab.cut == Approx(2.5 * area).epsilon(1e-12));
    CHECK(slab.areaWithoutPoints < 0.02 * area);

    auto measure = CutFillMeasure::make(square, *Base::plane({{0, 0, 0}, {0, 0, 1}}), 0.5);
    REQUIRE(measure.ok());
    RandomPlaces random(12);
    for (int i = 0; i < 60000; ++i) {
        Vec3d p{random.between(0, 20), random.between(0, 20), 0};
        p.z = 1 + 0.1 * p.x;
        if (std::hypot(p.x - 10, p.y - 10) > 3)
            measure->add(p);
    }
    auto result = measure->result();
    REQUIRE(result.ok());
    // Cells that lie in the hole as a whole.
    CHECK(result->areaWithoutPoints < std::numbers::pi * 3 * 3);
    CHECK(result->areaWithoutPoints > std::numbers::pi * (3 - std::sqrt(0.5)) * (3 - std::sqrt(0.5)));
    CHECK(result->cut == Approx(2 * 400).epsilon(0.002)); // the ramp goes on across the hole
}

TEST_CASE("what can't be measured is said") {
    Base level = *Base::plane({{0, 0, 0}, {0, 0, 1}});
    CHECK_FALSE(Base::plane({{0, 0, 0}, {1, 0, 0}}).ok());
    CHECK_FALSE(CutFillMeasure::make(square, level, 0).ok());
    CHECK_FALSE(CutFillMeasure::make(square, level, std::nan("")).ok());
    auto fine = CutFillMeasure::make(square, level, 1e-4);
    REQUIRE_FALSE(fine.ok());
    CHECK(fine.error().code == ErrorCode::limitExceeded);
    std::vector<Vec3d> bow{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}};
    CHECK_FALSE(CutFillMeasure::make(bow, level, 1).ok());
    CHECK_FALSE(Base::rim(bow).ok());
    auto empty = CutFillMeasure::make(square, level, 1);
    REQUIRE(empty.ok());
    empty->add({100, 100, 0});
    REQUIRE_FALSE(empty->result().ok());
    CHECK(empty->result().error().code == ErrorCode::notFound);
}
