// What is measured is the same at UTM, ECEF and 10^9 as at the origin: angles, azimuths, circles, areas and
// volumes of points with whole numbers of steps, against long double from these numbers.
#include "client/survey/areas.hpp"
#include "client/survey/circles.hpp"
#include "client/survey/exact_points.hpp"
#include "client/survey/lines.hpp"
#include "client/survey/volumes.hpp"
#include "tests/unit/client/survey/random_points.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

using namespace stipple;
using namespace stipple::survey;
using stipple::test::RandomPlaces;

namespace {

const std::array<Vec3d, 4> offsets{{{0, 0, 0},
                                    {691000.37, 5334000.11, 512.9},      // UTM
                                    {4178241.53, 856119.97, 4727034.23}, // ECEF
                                    {1e9, -1e9, 1e9}}};
constexpr double scale = 0.001;
constexpr long double pi = std::numbers::pi_v<long double>;

using Far = std::array<long double, 3>;

std::vector<GridPoint> randomPoints(RandomPlaces& random, const Vec3d& offset, int count) {
    Grid grid{{scale, scale, scale}, offset};
    std::vector<GridPoint> points;
    for (int i = 0; i < count; ++i)
        points.push_back({{random.integer(-900'000, 900'000), random.integer(-900'000, 900'000),
                           random.integer(-90'000, 90'000)},
                          grid});
    return points;
}

// From point b to point a.
Far way(const GridPoint& a, const GridPoint& b) {
    Far result{};
    for (int axis = 0; axis < 3; ++axis)
        result[static_cast<std::size_t>(axis)] =
            static_cast<long double>(scale) * static_cast<long double>(a.steps[axis] - b.steps[axis]);
    return result;
}
long double dotOf(const Far& a, const Far& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Far crossOf(const Far& a, const Far& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
long double lengthOf(const Far& a) {
    return std::sqrt(dotOf(a, a));
}

void keepWorst(double& worst, double found, long double truth) {
    worst = std::max(worst, static_cast<double>(std::abs(found / truth - 1)));
}

} // namespace

TEST_CASE("angles, azimuths, circles and areas of far points are those of their integers", "[numerics]") {
    RandomPlaces random(41);
    double angle = 0, azimuth = 0, radius = 0, inPlane = 0;
    for (const Vec3d& offset : offsets)
        for (int i = 0; i < 500; ++i) {
            std::vector<GridPoint> points = randomPoints(random, offset, 3);
            std::vector<Vec3d> local = localPoints(points);
            Far u = way(points[1], points[0]), v = way(points[2], points[0]), n = crossOf(u, v);
            keepWorst(angle, angleAt(local[0], local[1], local[2]).value(),
                      std::atan2(lengthOf(n), dotOf(u, v)) * 180 / pi);
            long double turn = std::atan2(u[0], u[1]) * 180 / pi;
            keepWorst(azimuth, measureSegment(local[0], local[1]).azimuth.value(),
                      turn < 0 ? turn + 360 : turn);
            auto circle = circleThrough(local[0], local[1], local[2]);
            REQUIRE(circle.ok());
            keepWorst(radius, circle->radius,
                      lengthOf(u) * lengthOf(v) * lengthOf(way(points[2], points[1])) / (2 * lengthOf(n)));
            keepWorst(inPlane, measureArea(local).inPlane, lengthOf(n) / 2);
        }
    std::printf(
        "  worst relative error at any offset: angle %.2g, azimuth %.2g, radius %.2g, area in plane %.2g\n",
        angle, azimuth, radius, inPlane);
    CHECK(angle < 1e-12);
    CHECK(azimuth < 1e-12);
    CHECK(radius < 1e-12);
    CHECK(inPlane < 1e-12);
}

TEST_CASE("volumes of far points are those of their integers", "[numerics]") {
    RandomPlaces random(42);
    double worst = 0;
    for (const Vec3d& offset : offsets)
        for (int round = 0; round < 5; ++round) {
            // Cells of 4 m, 25 by 20, with four points each about the cell's middle; a level base.
            constexpr int columns = 25, rows = 20, side = 4000;
            Grid grid{{scale, scale, scale}, offset};
            Vec3i first{random.integer(-900'000, 900'000), random.integer(-900'000, 900'000),
                        random.integer(-9'000, 9'000)};
            auto at = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
                return GridPoint{{first.x + x, first.y + y, first.z + z}, grid};
            };
            std::vector<GridPoint> corners{at(0, 0, 0), at(columns * side, 0, 0),
                                           at(columns * side, rows * side, 0), at(0, rows * side, 0)};
            auto base = Base::plane({{}, {0, 0, 1}});
            REQUIRE(base.ok());
            auto measure = CutFillMeasure::make(localPoints(corners), *base, side * scale);
            REQUIRE(measure.ok());
            long double cut = 0, fill = 0;
            for (int column = 0; column < columns; ++column)
                for (int row = 0; row < rows; ++row) {
                    std::int64_t sum = 0;
                    for (std::int64_t point = 0; point < 4; ++point) {
                        std::int64_t z = random.integer(-30'000, 30'000);
                        sum += z;
                        GridPoint place = at(column * side + 1000 + 700 * (point % 2),
                                             row * side + 1500 + 900 * (point / 2), z);
                        measure->add(difference(place, corners.front()));
                    }
                    long double cellSide = static_cast<long double>(scale) * side;
                    long double volume = cellSide * cellSide * scale * static_cast<long double>(sum) / 4;
                    (volume > 0 ? cut : fill) += std::abs(volume);
                }
            auto result = measure->result();
            REQUIRE(result.ok());
            keepWorst(worst, result->cut, cut);
            keepWorst(worst, result->fill, fill);
            CHECK(result->points == 4 * columns * rows);
        }
    std::printf("  worst relative error of cut and fill at any offset: %.2g\n", worst);
    CHECK(worst < 1e-12);
}
