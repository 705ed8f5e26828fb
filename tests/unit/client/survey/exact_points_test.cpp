// Differences of points in far places and on different grids, against long double from the same integers.
#include "client/survey/areas.hpp"
#include "client/survey/exact_points.hpp"
#include "client/survey/lines.hpp"
#include "tests/unit/client/survey/random_points.hpp"

#include <catch2/catch.hpp>

#include <cstdio>

using namespace stipple;
using namespace stipple::survey;
using stipple::test::RandomPlaces;

namespace {

struct Place {
    const char* name;
    Vec3d offset;
    double scale;
};
const Place places[] = {{"origin", {0, 0, 0}, 0.001},
                        {"UTM", {691000.37, 5334000.11, 512.9}, 0.001},
                        {"UTM, 10 µm", {691000.37, 5334000.11, 512.9}, 0.00001},
                        {"ECEF", {4178241.53, 856119.97, 4727034.23}, 0.001},
                        {"10^9", {1e9, -1e9, 1e9}, 0.001},
                        {"10^12", {1e12, 1e12, -1e12}, 0.01}};

} // namespace

TEST_CASE("points of one grid are as far apart as their integers say, wherever they lie", "[numerics]") {
    RandomPlaces random(1);
    double worst = 0, worstArea = 0;
    for (const Place& place : places)
        for (int i = 0; i < 200; ++i) {
            Grid grid{{place.scale, place.scale, place.scale}, place.offset};
            std::vector<GridPoint> corners;
            for (int c = 0; c < 4; ++c)
                corners.push_back({{random.integer(-2'000'000'000, 2'000'000'000),
                                    random.integer(-50'000, 50'000), random.integer(-20'000, 20'000)},
                                   grid});
            std::vector<Vec3d> local = localPoints(corners);
            auto exact = [&](std::size_t a, std::size_t b, int axis) {
                return static_cast<long double>(place.scale) *
                       static_cast<long double>(corners[a].steps[axis] - corners[b].steps[axis]);
            };
            long double square = 0, plan = 0;
            for (int axis = 0; axis < 3; ++axis)
                square += exact(1, 0, axis) * exact(1, 0, axis);
            double distance = measureSegment(local[0], local[1]).distance;
            worst = std::max(worst, static_cast<double>(std::abs(distance / std::sqrt(square) - 1)));
            for (std::size_t c = 0; c < 4; ++c)
                plan += exact(c, 0, 0) * exact((c + 1) % 4, 0, 1) - exact(c, 0, 1) * exact((c + 1) % 4, 0, 0);
            long double area = std::abs(plan) / 2;
            worstArea =
                std::max(worstArea, static_cast<double>(std::abs(measureArea(local).horizontal / area - 1)));
        }
    std::printf("  worst relative error at any offset: distance %.2g, area %.2g\n", worst, worstArea);
    CHECK(worst < 1e-15);
    CHECK(worstArea < 1e-12);
}

TEST_CASE("points of different grids differ by what their grids say, rounded once", "[numerics]") {
    RandomPlaces random(2);
    double worst = 0;
    for (const Place& place : places)
        for (int i = 0; i < 500; ++i) {
            Grid a{{place.scale, place.scale, place.scale}, place.offset};
            Grid b{{0.0025, 0.0025, 0.0025},
                   place.offset + Vec3d{random.between(-9, 9), random.between(-9, 9), random.between(-9, 9)}};
            GridPoint p{{random.integer(-9'000'000, 9'000'000), 5, 7}, a};
            GridPoint q{{random.integer(-9'000'000, 9'000'000), -5, 7}, b};
            Vec3d way = difference(p, q);
            for (int axis = 0; axis < 3; ++axis) {
                // The offsets' difference is exact in long double (64 bits), as are the products here.
                long double truth = (static_cast<long double>(a.offset[axis]) - b.offset[axis]) +
                                    (static_cast<long double>(a.scale[axis]) * p.steps[axis] -
                                     static_cast<long double>(b.scale[axis]) * q.steps[axis]);
                // What long double itself loses in the products.
                long double slack =
                    1e-19L * std::abs(a.scale[axis] * static_cast<long double>(p.steps[axis]));
                long double off = std::abs(way[axis] - truth) - 4 * slack;
                worst = std::max(worst, static_cast<double>(off / std::abs(truth)));
            }
        }
    std::printf("  worst relative error between grids: %.2g\n", worst);
    CHECK(worst < 3e-16);
}

TEST_CASE("world coordinates lose at 10^9 what exact differences keep") {
    Grid grid{{0.001, 0.001, 0.001}, {1e9, 1e9, 1e9}};
    GridPoint a{{1, 0, 0}, grid}, b{{4, 4, 0}, grid};
    CHECK(length(difference(b, a)) == Approx(0.005).epsilon(1e-15));
    double byWorld = length(grid.toWorld(b.steps) - grid.toWorld(a.steps));
    CHECK(std::abs(byWorld / 0.005 - 1) > 1e-6);
    CHECK(localPoints({}).empty());
}
