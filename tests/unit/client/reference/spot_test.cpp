// Discs of the reference against what they are made of: points of the disc itself, put through the view.
#include "client/reference/spot.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <random>

using namespace stipple;
using reference::Mark;
using reference::Place;
using reference::Spot;
using reference::View;

namespace {

struct Disc {
    Vec3d middle, normal;
    Mark mark;
};

// Points of a disc of that many radii, all around it.
template <class Visit>
void visitRing(const Disc& disc, double radius, const Visit& visit) {
    Vec3d side =
        normalized(cross(disc.normal, std::abs(disc.normal.z) < 0.8 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0}));
    Vec3d other = cross(disc.normal, side);
    for (int i = 0; i < 24; ++i) {
        double angle = i * std::numbers::pi / 12;
        visit(disc.middle + (side * std::cos(angle) + other * std::sin(angle)) * radius);
    }
}

// A view from the origin along y, with a disc somewhere in it; `made` as appendMarks() makes it.
Disc randomDisc(const View& view, std::mt19937_64& random, double diameter) {
    std::uniform_real_distribution<double> unit(-1, 1);
    Disc disc;
    disc.middle = {4 * unit(random), 10 + 3 * unit(random), 4 * unit(random)};
    do
        disc.normal = normalized(Vec3d{unit(random), unit(random), unit(random)});
    while (std::abs(dot(disc.normal, disc.middle)) < 0.05 * length(disc.middle)); // not along its plane
    Grid grid{{1e-9, 1e-9, 1e-9}, {0, 0, 0}};
    PointBatch batch;
    reference::Points points;
    for (const char* name : {"nx", "ny", "nz"})
        points.attributes.push_back({name, AttributeType::f64});
    batch.resize({points.attributes}, 1);
    for (int axis = 0; axis < 3; ++axis) {
        batch.positions[0][axis] = std::llround(disc.middle[axis] * 1e9);
        batch.setValue<double>(axis, 0, disc.normal[axis] * 7);
    }
    points.grid = &grid;
    points.batch = &batch;
    Style style;
    style.shape = PointShape::disc;
    style.sizePixels = diameter;
    style.maxSizePixels = 200;
    std::vector<Mark> marks;
    appendMarks(view, style, points, marks);
    REQUIRE(marks.size() == 1);
    disc.mark = marks[0];
    return disc;
}

View viewOf(Projection projection) {
    Camera camera;
    camera.projection = projection;
    camera.position = {0, 0, 0};
    camera.target = {0, 10, 0};
    camera.fovYDegrees = 90;
    camera.orthoHeight = 20;
    return reference::viewOf(camera, 400, 400, {});
}

} // namespace

TEST_CASE("a place is on a disc where the disc's own points are seen, at their distance") {
    std::mt19937_64 random(1);
    for (Projection projection : {Projection::perspective, Projection::orthographic})
        for (double diameter : {3.0, 30.0, 150.0})
            for (int i = 0; i < 50; ++i) {
                View view = viewOf(projection);
                Disc disc = randomDisc(view, random, diameter);
                double radius = diameter / 2 * disc.mark.unitsPerPixel;
                auto spotAt = [&](Vec3d world, Place& at) {
                    REQUIRE(place(view, {world.x, world.y, world.z}, at));
                    return spotOf(disc.mark, at.x - disc.mark.x, at.y - disc.mark.y, PointShape::disc,
                                  nullptr);
                };
                for (double share : {0.2, 0.999})
                    visitRing(disc, share * radius, [&](Vec3d world) {
                        Place at;
                        Spot spot = spotAt(world, at);
                        double far = std::max(std::abs(at.x - disc.mark.x), std::abs(at.y - disc.mark.y));
                        CHECK(far <= reachOf(disc.mark, PointShape::disc) + (far > 127.5 ? 1e9 : 0));
                        if (far > 127.5)
                            return;
                        CHECK(spot.inside > 0);
                        CHECK(spot.distance == Approx(at.distance).epsilon(1e-7));
                        CHECK(spot.away == Approx(share * diameter / 2).epsilon(1e-5));
                    });
                visitRing(disc, 1.001 * radius, [&](Vec3d world) {
                    Place at;
                    Spot spot = spotAt(world, at);
                    bool holds = std::max(std::abs(at.x - disc.mark.x), std::abs(at.y - disc.mark.y)) < 0.5;
                    CHECK((spot.inside < 0) == !holds);
                });
            }
}

TEST_CASE("a disc behind its horizon is not there, and its point is all the same") {
    Mark mark;
    mark.distance = 10;
    mark.diameter = 100;
    mark.unitsPerPixel = 0.05;
    mark.slopePerPixel = 0.005;
    mark.normal = normalized(Vec3d{0, 1, 0.1}); // nearly along the ray
    CHECK(spotOf(mark, 0, 0.2, PointShape::disc, nullptr).inside > 0);
    CHECK(spotOf(mark, 0, 30, PointShape::disc, nullptr).inside < 0);
    CHECK(spotOf(mark, 0, -30, PointShape::disc, nullptr).inside < 0);
    mark.normal = {0, 1, 0};
    CHECK(spotOf(mark, 0.1, 0.2, PointShape::disc, nullptr).inside > 0);
    CHECK(spotOf(mark, 0.1, 0.2, PointShape::disc, nullptr).distance == 10);
    CHECK(spotOf(mark, 20, 0.6, PointShape::disc, nullptr).inside < 0);
    mark.slopePerPixel = 0;
    CHECK(spotOf(mark, 20, 0.6, PointShape::disc, nullptr).inside < 0);
}
