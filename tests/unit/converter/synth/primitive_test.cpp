#include "converter/synth/intersect.hpp"
#include "converter/synth/model.hpp"
#include "converter/synth/random.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::synth;

namespace {

Vec3d point(Random& random, double size) {
    return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

Primitive randomPrimitive(Random& random) {
    Model m;
    Vec3d a = point(random, 5), b = point(random, 5), c = point(random, 5);
    switch (random.integer(0, 3)) {
    case 0:
        m.triangle(a, b, c, Material::wall);
        break;
    case 1:
        m.disc(a, b, random.uniform(0.05, 3), Material::leafBroad);
        break;
    case 2:
        m.frustum(a, b, random.uniform(0.02, 1), random.uniform(0.02, 1), Material::bark);
        break;
    default:
        m.sphere(a, random.uniform(0.02, 2), Material::lampShade);
        break;
    }
    return m.primitives[0];
}

} // namespace

TEST_CASE("a hit lies on the surface, from a metre and from a kilometre away") {
    Random random(1);
    std::size_t hits = 0;
    for (int i = 0; i < 20000; ++i) {
        Primitive p = randomPrimitive(random);
        double away = random.chance(0.5) ? 6 : 1200;
        Vec3d from = point(random, 1), target = toDouble(p.a) + point(random, 1);
        from = target + normalized(from) * away;
        Ray ray{from, normalized(target - from)};
        double distance = intersect(p, ray, 1e-6);
        if (distance == noHit)
            continue;
        ++hits;
        Vec3d at = ray.origin + ray.direction * distance;
        REQUIRE(distanceTo(p, at) < 1e-7);
        REQUIRE(length(normalAt(p, at)) == Approx(1));
    }
    CHECK(hits > 3000);
}

TEST_CASE("the distance to a surface is the smallest over many points of it") {
    Random random(2);
    for (int i = 0; i < 60; ++i) {
        Primitive p = randomPrimitive(random);
        Vec3d from = point(random, 8);
        double stated = distanceTo(p, from), found = noHit;
        // Points of the surface come from rays shot through it.
        for (int k = 0; k < 4000; ++k) {
            Ray ray{point(random, 9), {}};
            ray.direction = normalized(toDouble(p.a) + point(random, 6) - ray.origin);
            double distance = intersect(p, ray, 0);
            if (distance == noHit)
                continue;
            double d = length(ray.origin + ray.direction * distance - from);
            REQUIRE(d >= stated - 1e-7);
            found = std::min(found, d);
        }
        if (found != noHit)
            CHECK(found < stated + 2.5);
    }
}

TEST_CASE("a ray through a cylinder meets its near wall, then its far one") {
    Model m;
    m.cylinder({0, 0, 0}, {0, 0, 4}, 0.5, Material::wall);
    Ray ray{{-10, 0, 2}, {1, 0, 0}};
    double first = intersect(m.primitives[0], ray, 0);
    CHECK(first == Approx(9.5));
    CHECK(intersect(m.primitives[0], ray, first + 1e-6) == Approx(10.5));
    CHECK(intersect(m.primitives[0], {{-10, 0, 5}, {1, 0, 0}}, 0) == noHit);
}

TEST_CASE("the box of a primitive holds every hit") {
    Random random(3);
    for (int i = 0; i < 20000; ++i) {
        Primitive p = randomPrimitive(random);
        Ray ray{point(random, 9), {}};
        ray.direction = normalized(toDouble(p.a) + point(random, 1) - ray.origin);
        double distance = intersect(p, ray, 0);
        if (distance == noHit)
            continue;
        Vec3f at = toFloat(ray.origin + ray.direction * distance);
        Box<float> box = boundsOf(p);
        for (int axis = 0; axis < 3; ++axis) {
            REQUIRE(at[axis] >= box.min[axis] - 1e-4f);
            REQUIRE(at[axis] <= box.max[axis] + 1e-4f);
        }
    }
}

TEST_CASE("a wall with a window lets a ray through the pane's plane and stops one beside it") {
    Model m;
    addWall(m, {{0, 0},
                {6, 0},
                0,
                3,
                0.3,
                Material::wall,
                Material::wallInside,
                {{2, 3, 1, 2, Opening::Kind::hole}}});
    auto nearest = [&](Ray ray) {
        double best = noHit;
        for (const Primitive& p : m.primitives)
            best = std::min(best, intersect(p, ray, 0));
        return best;
    };
    CHECK(nearest({{2.5, -5, 1.5}, {0, 1, 0}}) == noHit);
    CHECK(nearest({{1.0, -5, 1.5}, {0, 1, 0}}) == Approx(5));
    CHECK(nearest({{1.0, 5, 1.5}, {0, -1, 0}}) == Approx(4.7)); // thickness
}
