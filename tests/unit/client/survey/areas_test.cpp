#include "client/survey/areas.hpp"
#include "client/survey/symmetric_matrix.hpp"
#include "tests/unit/client/survey/random_points.hpp"

#include <catch2/catch.hpp>

#include <numbers>

using namespace stipple;
using namespace stipple::survey;
using stipple::test::RandomPlaces;

namespace {

// A regular polygon around `centre` in the plane of u and v.
std::vector<Vec3d> regular(int n, double radius, Vec3d centre, Vec3d u, Vec3d v) {
    std::vector<Vec3d> corners;
    for (int i = 0; i < n; ++i) {
        double turn = 2 * std::numbers::pi * i / n;
        corners.push_back(centre + u * (radius * std::cos(turn)) + v * (radius * std::sin(turn)));
    }
    return corners;
}

} // namespace

TEST_CASE("areas of regular polygons in any plane", "[numerics]") {
    RandomPlaces random(5);
    double worst = 0;
    for (int i = 0; i < 500; ++i) {
        int n = static_cast<int>(random.integer(3, 40));
        double radius = random.between(0.01, 1000);
        Vec3d normal = random.unit();
        Vec3d u = normalized(cross(normal, random.unit())), v = cross(normal, u);
        Area area = measureArea(regular(n, radius, {3, 4, 5}, u, v));
        double truth = 0.5 * n * radius * radius * std::sin(2 * std::numbers::pi / n);
        worst = std::max(worst, std::abs(area.inPlane / truth - 1));
        CHECK(area.horizontal == Approx(truth * std::abs(normal.z)).epsilon(1e-10).margin(1e-9));
        CHECK(area.perimeter == Approx(2 * n * radius * std::sin(std::numbers::pi / n)));
        CHECK(area.deviation < 1e-12 * radius + 1e-14);
        CHECK_FALSE(area.crosses);
        CHECK(area.plane.normal.z >= 0);
    }
    CHECK(worst < 1e-11); // of the corners' own rounding at (3, 4, 5) with a radius of 0.01
}

TEST_CASE("a thin parcel keeps its area", "[numerics]") {
    // 10 km long, 1 mm wide, askew, exactly: corners are integers of a grid of 1/1024.
    double w = 1.0 / 1024;
    std::vector<Vec3d> parcel{{0, 0, 0}, {8192, 4096, 0}, {8192 - w, 4096 + 2 * w, 0}, {-w, 2 * w, 0}};
    CHECK(measureArea(parcel).horizontal == Approx(8192 * 2 * w + 4096 * w).epsilon(1e-15));
}

TEST_CASE("corners off their plane are said, and edges that cross") {
    std::vector<Vec3d> square{{0, 0, 0.1}, {2, 0, -0.1}, {2, 2, 0.1}, {0, 2, -0.1}};
    Area area = measureArea(square);
    CHECK(area.horizontal == 4);
    CHECK(area.inPlane == Approx(4));
    CHECK(area.deviation == Approx(0.1));
    std::vector<Vec3d> bow{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}};
    CHECK(measureArea(bow).crosses);
    std::vector<Vec3d> touching{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}};
    CHECK(measureArea(touching).crosses);
}

TEST_CASE("points, lines and upright lines have planes, and no area") {
    CHECK(measureArea({}).horizontal == 0);
    CHECK(measureArea(std::vector<Vec3d>{{1, 2, 3}}).plane.normal == Vec3d{0, 0, 1});
    Area line = measureArea(std::vector<Vec3d>{{0, 0, 0}, {1, 0, 1}, {2, 0, 2}});
    CHECK(line.horizontal == 0);
    CHECK(line.inPlane == Approx(0).margin(1e-15));
    CHECK(line.plane.normal.z == Approx(std::sqrt(0.5)));
    Area upright = measureArea(std::vector<Vec3d>{{0, 0, 0}, {0, 0, 1}, {0, 0, 5}});
    CHECK(std::abs(upright.plane.normal.z) < 1e-12);
    CHECK(length(upright.plane.normal) == Approx(1));
}

TEST_CASE("the axes of a symmetric matrix are those it was made from", "[numerics]") {
    RandomPlaces random(6);
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
        Vec3d a = random.unit(), b = normalized(cross(a, random.unit())), c = cross(a, b);
        double values[] = {random.between(0, 1e-6), random.between(0.1, 1), random.between(2, 100)};
        SymmetricMatrix matrix;
        matrix.addSquare(a * std::sqrt(values[0]));
        matrix.addSquare(b * std::sqrt(values[1]));
        matrix.addSquare(c * std::sqrt(values[2]));
        Eigenvectors found = eigenvectors(matrix);
        worst = std::max(worst, length(cross(found.vectors[0], a)));
        CHECK(found.values[2] == Approx(values[2]).epsilon(1e-13));
        CHECK(found.values[1] == Approx(values[1]).epsilon(1e-11));
    }
    CHECK(worst < 1e-12);
}
