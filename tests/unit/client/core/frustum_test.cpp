#include "client/core/frustum.hpp"

#include "client/core/camera.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>

using namespace stipple;

namespace {

// View distance at which a ray of the picture, (x, y) in -1..1, enters the box; infinite if it misses.
double entryOf(const ViewTransform& view, const BoxD& box, double x, double y) {
    Vec3d ray =
        view.forward + view.right * (x * view.tanHalfFovY * view.aspect) + view.up * (y * view.tanHalfFovY);
    double from = 0, to = HUGE_VAL;
    for (int axis = 0; axis < 3; ++axis) {
        double a = (box.min[axis] - view.eye[axis]) / ray[axis],
               b = (box.max[axis] - view.eye[axis]) / ray[axis];
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    }
    return from <= to ? from : HUGE_VAL;
}

} // namespace

TEST_CASE("the nearest distance of a box is that of its part in the picture") {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    auto any = [&](double size) {
        return Vec3d{size * (unit(random) - 0.5), size * (unit(random) - 0.5), size * (unit(random) - 0.5)};
    };
    int cut = 0, seen = 0;
    for (int round = 0; round < 500; ++round) {
        BoxD box;
        Vec3d corner = any(40);
        box.extend(corner);
        box.extend(corner + any(30));
        Camera camera;
        camera.position = any(60);
        camera.target = any(30);
        camera.fovYDegrees = 20 + 60 * unit(random);
        ViewTransform view = viewTransform(camera, 800, 600, box);
        double sampled = HUGE_VAL;
        constexpr int rays = 120;
        for (int y = -rays; y <= rays; ++y)
            for (int x = -rays; x <= rays; ++x)
                sampled = std::min(sampled, entryOf(view, box, double(x) / rays, double(y) / rays));
        if (sampled == HUGE_VAL)
            continue; // outside, or seen by less than a ray
        ++seen;
        double nearest = Frustum(view).nearestDistance(box);
        REQUIRE(nearest <= sampled * (1 + 1e-9) + 1e-9);
        // Rays lie 1/120 of half the picture apart.
        REQUIRE(sampled - nearest <= 0.06 * (sampled + 1));
        double own = HUGE_VAL;
        for (int c = 0; c < 8; ++c)
            own = std::min(own, dot(Vec3d{c & 1 ? box.max.x : box.min.x, c & 2 ? box.max.y : box.min.y,
                                          c & 4 ? box.max.z : box.min.z} -
                                        view.eye,
                                    view.forward));
        cut += nearest > own + 0.1 * std::abs(own);
    }
    CHECK(seen > 200);
    CHECK(cut > 50); // the picture's edge decided, not the box's corner
}

TEST_CASE("a box around the eye is at no distance, one behind it neither") {
    Camera camera;
    camera.position = {0, 0, 0};
    camera.target = {0, 10, 0};
    BoxD around{{-1, -1, -1}, {1, 1, 1}}, behind{{-1, -9, -1}, {1, -4, 1}}, beside{{5, 1, -1}, {9, 2, 1}};
    ViewTransform view = viewTransform(camera, 800, 600, around);
    CHECK(Frustum(view).nearestDistance(around) == 0);
    CHECK(Frustum(view).nearestDistance(behind) == 0);
    CHECK(Frustum(view).nearestDistance(beside) == Approx(1)); // outside: its own
}
