// What numbers do to cameras, frusta and projection: offsets from 0 to 10^12, views from 10^-4 to 10^8 units
// away, fields of view from 0.5 to 170 degrees, degenerate boxes, directions along `up`. Truth is long double
// from the same doubles on. Each test prints the worst it saw: docs/NUMERICS.md.
#include "client/core/camera.hpp"
#include "client/core/frustum.hpp"
#include "client/core/json.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

using namespace stipple;

namespace {

using Real = long double;
using Vec3r = Vec3<Real>;

constexpr int width = 1920, height = 1080;
constexpr std::array<double, 6> offsets{0, 1e3, 5e6, 1e9, 1e11, 1e12};
constexpr std::array<double, 7> distances{1e-4, 1e-2, 1, 1e2, 1e4, 1e6, 1e8};
constexpr std::array<double, 6> fields{0.5, 5, 30, 60, 120, 170};
constexpr double ulp = std::numeric_limits<double>::epsilon();

Vec3r wide(Vec3d v) {
    return {v.x, v.y, v.z};
}

// Directions all around, along the axes and close to `up`.
std::vector<Vec3d> directions() {
    std::vector<Vec3d> all{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {0, -1, 0}, {1, 1, -1}, {-3, 2, 0.5}};
    for (double tilt : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 1e-300})
        for (double down : {-1.0, 1.0}) {
            all.push_back({tilt, 0, down});
            all.push_back({-tilt, tilt / 3, down});
        }
    return all;
}

// visit(camera) for every combination that has a direction: the distance is far above the coordinates'
// resolution.
template <class Visit>
void visitCameras(const Visit& visit) {
    for (double offset : offsets)
        for (double distance : distances) {
            if (distance < 1e4 * ulp * offset)
                continue;
            for (double field : fields)
                for (Vec3d direction : directions())
                    for (Projection projection : {Projection::perspective, Projection::orthographic}) {
                        Camera camera;
                        camera.projection = projection;
                        camera.target = {offset, -offset, offset / 3};
                        camera.position = camera.target - normalized(direction) * distance;
                        camera.fovYDegrees = field;
                        camera.orthoHeight = distance;
                        visit(camera);
                    }
        }
}

BoxD around(Vec3d centre, double size) {
    Vec3d half{size / 2, size / 2, size / 2};
    return {centre - half, centre + half};
}

struct PixelR {
    Real x, y, depth;
};
PixelR truePixel(const ViewTransform& view, const Camera& camera, Vec3d world) {
    Vec3r relative = wide(world) - wide(camera.position);
    Real depth = dot(relative, wide(view.forward));
    Real half = view.projection == Projection::perspective ? view.tanHalfFovY * depth : Real{view.halfHeight};
    Real scale = height / (2 * half);
    return {Real{0.5} * width + dot(relative, wide(view.right)) * scale,
            Real{0.5} * height - dot(relative, wide(view.up)) * scale, depth};
}

double ulpOf(Vec3d v) {
    return ulp * std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

} // namespace

TEST_CASE("axes are orthonormal to a few units in the last place, whatever the camera", "[numerics]") {
    double worst = 0;
    visitCameras([&](const Camera& camera) {
        ViewTransform view = viewTransform(camera, width, height, around(camera.target, 10));
        for (double error : {dot(view.right, view.up), dot(view.up, view.forward),
                             dot(view.forward, view.right), length(view.right) - 1, length(view.up) - 1,
                             length(view.forward) - 1, length(cross(view.right, view.up) + view.forward)})
            worst = std::max(worst, std::abs(error) / ulp);
    });
    std::printf("axes: off by at most %.1f ulp\n", worst);
    CHECK(worst < 8);
}

TEST_CASE("near and far are finite and in order for any content", "[numerics]") {
    auto check = [](const Camera& camera, const BoxD& content) {
        ViewTransform view = viewTransform(camera, width, height, content);
        bool good = view.near > 0 && view.near < view.far && std::isfinite(view.far) &&
                    std::isfinite(view.eye.x) && view.far / view.near <= 0x1p31 * (1 + 1e-9);
        if (!good)
            FAIL("near " << view.near << ", far " << view.far);
    };
    visitCameras([&](const Camera& camera) {
        for (double size : {0.0, 1e-6, 1.0, 1e7}) {
            check(camera, around(camera.target, size));
            check(camera, around(camera.position, size));
            BoxD flat = around(camera.target, size), line = flat;
            flat.min.z = flat.max.z;
            line.min.y = line.max.y;
            line.min.z = line.max.z;
            check(camera, flat);
            check(camera, line);
        }
        check(camera, {});
        check(camera, {{-1e12, -1e12, -1e12}, {1e12, 1e12, 1e12}});
    });
    SUCCEED();
}

TEST_CASE("named cameras show degenerate boxes at any offset", "[numerics]") {
    for (double offset : offsets)
        for (Vec3d size :
             {Vec3d{0, 0, 0}, {5, 0, 0}, {0, 5, 0}, {0, 0, 5}, {5, 5, 0}, {0, 5, 5}, {1e-3, 1e3, 1}})
            for (NamedView name : {NamedView::top, NamedView::front, NamedView::side, NamedView::iso})
                for (Projection projection : {Projection::perspective, Projection::orthographic}) {
                    Vec3d corner{offset, offset, offset};
                    BoxD box{corner, corner + size};
                    Camera camera = namedCamera(name, box, 16.0 / 9, projection);
                    INFO(offset << ": " << size.x << " " << size.y << " " << size.z);
                    REQUIRE(isUsable(camera));
                    ViewTransform view = viewTransform(camera, width, height, box);
                    double resolution = ulpOf(camera.position) * height /
                                        (projection == Projection::perspective
                                             ? 2 * view.tanHalfFovY * length(camera.target - camera.position)
                                             : 2 * view.halfHeight);
                    for (Vec3d at : {box.min, box.max}) {
                        Vec3d pixel = projectToPixels(view, width, height, at);
                        CHECK(pixel.x >= -1 - 4 * resolution);
                        CHECK(pixel.x <= width + 1 + 4 * resolution);
                        CHECK(pixel.y >= -1 - 4 * resolution);
                        CHECK(pixel.y <= height + 1 + 4 * resolution);
                    }
                }
}

// In perspective only the difference of two doubles is rounded. In orthographic views the eye is moved along
// the direction and rounded to a double, which moves the picture by at most that.
TEST_CASE("projection is exact to the rounding of the eye", "[numerics]") {
    double worstPerspective = 0, worstOrthographic = 0;
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    visitCameras([&](const Camera& camera) {
        BoxD content = around(camera.target, length(camera.target - camera.position));
        ViewTransform view = viewTransform(camera, width, height, content);
        for (int i = 0; i < 3; ++i) {
            bool perspective = camera.projection == Projection::perspective;
            double depth = length(camera.target - camera.position) * std::pow(10.0, unit(random));
            double half = perspective ? view.tanHalfFovY * depth : view.halfHeight;
            Vec3d world = camera.position + view.forward * depth +
                          view.right * (unit(random) * half * view.aspect) + view.up * (unit(random) * half);
            Vec3d pixel = projectToPixels(view, width, height, world);
            PixelR truth = truePixel(view, camera, world);
            // Rounding of the point itself may take it behind the camera.
            if (perspective && truth.depth < Real{0.1} * depth)
                continue;
            auto error = static_cast<double>(std::hypot(pixel.x - truth.x, pixel.y - truth.y));
            if (perspective) {
                worstPerspective = std::max(worstPerspective, error);
            } else {
                double allowed = 1e-9 + 2 * ulpOf(view.eye) * height / (2 * view.halfHeight);
                if (error > allowed)
                    FAIL("off by " << error << " pixels, " << allowed << " allowed");
                worstOrthographic = std::max(worstOrthographic, error / allowed);
            }
        }
    });
    std::printf("projection: perspective off by at most %.2g pixels, orthographic by %.2f of what rounding "
                "the eye allows\n",
                worstPerspective, worstOrthographic);
    CHECK(worstPerspective < 1e-9);
}

TEST_CASE("a frustum never loses a box that holds a point of the picture", "[numerics]") {
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::size_t held = 0, lost = 0;
    visitCameras([&](const Camera& camera) {
        double distance = length(camera.target - camera.position);
        ViewTransform view = viewTransform(camera, width, height, around(camera.target, distance));
        Frustum frustum(view);
        for (int i = 0; i < 4; ++i) {
            // A point well inside the picture (0.001 pixel from its edge), and a box with that point at its
            // corner, on a side or inside: of any size in each direction, 0 included.
            bool perspective = camera.projection == Projection::perspective;
            double depth = distance * std::pow(10.0, 3 * unit(random));
            double half = perspective ? view.tanHalfFovY * depth : view.halfHeight;
            Vec3d point = camera.position + view.forward * depth +
                          view.right * (unit(random) * half * view.aspect) + view.up * (unit(random) * half);
            PixelR truth = truePixel(view, camera, point);
            Real edge = Real{0.001} + 4 * ulpOf(point) * height / (2 * half);
            if (truth.depth <= 0 || truth.x < edge || truth.x > width - edge || truth.y < edge ||
                truth.y > height - edge)
                continue;
            BoxD box{point, point};
            for (int axis = 0; axis < 3; ++axis)
                for (Vec3d* end : {&box.min, &box.max}) {
                    double grow = unit(random) < 0 ? 0 : distance * std::pow(10.0, 4 * unit(random));
                    (*end)[axis] += end == &box.min ? -grow : grow;
                }
            ++held;
            lost += !frustum.intersects(box);
        }
    });
    std::printf("frustum: %zu of %zu boxes lost that hold a point of the picture\n", lost, held);
    CHECK(held > 5000);
    CHECK(lost == 0);
}

TEST_CASE("a frustum discards boxes beyond one of its sides", "[numerics]") {
    std::mt19937_64 random(10);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::size_t outside = 0, kept = 0;
    visitCameras([&](const Camera& camera) {
        if (camera.projection != Projection::perspective)
            return;
        double distance = length(camera.target - camera.position);
        ViewTransform view = viewTransform(camera, width, height, around(camera.target, distance));
        Frustum frustum(view);
        const std::array<Vec3d, 4> normals{
            view.right - view.forward * (view.tanHalfFovY * view.aspect),
            view.right * -1.0 - view.forward * (view.tanHalfFovY * view.aspect),
            view.up - view.forward * view.tanHalfFovY, view.up * -1.0 - view.forward * view.tanHalfFovY};
        for (Vec3d normal : normals) {
            Vec3d out = normalized(normal);
            // A box whose nearest corner is a hundredth of its distance beyond that side's plane.
            double size = distance * std::pow(10.0, unit(random)), away = 2 * size + distance;
            Vec3d middle = camera.position + out * away;
            ++outside;
            kept += frustum.intersects(around(middle, size));
        }
    });
    std::printf("frustum: %zu of %zu boxes kept that lie beyond one of its sides\n", kept, outside);
    CHECK(outside > 2000);
    CHECK(kept == 0);
}

TEST_CASE("a sphere around another one never shows smaller", "[numerics]") {
    std::mt19937_64 random(12);
    std::uniform_real_distribution<double> unit(-1, 1);
    visitCameras([&](const Camera& camera) {
        double distance = length(camera.target - camera.position);
        ViewTransform view = viewTransform(camera, width, height, around(camera.target, distance));
        Vec3d centre = camera.target + Vec3d{unit(random), unit(random), unit(random)} * distance;
        double radius = distance * std::pow(10.0, 3 * unit(random));
        // An octree's child: half the radius, its centre half a radius away.
        Vec3d child = centre + normalized(Vec3d{1, unit(random) > 0 ? 1.0 : -1.0, 1}) * (radius / 2);
        double outer = projectedPixels(view, height, centre, radius);
        double inner = projectedPixels(view, height, child, radius / 2);
        if (!(outer > 0) || inner > outer * (1 + 1e-9))
            FAIL(inner << " in " << outer);
    });
    SUCCEED();
}

TEST_CASE("no step of interaction takes a number that is none, or leaves the finite", "[numerics]") {
    Camera camera;
    for (double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        for (const Camera& after :
             {orbit(camera, bad, 0, height), orbit(camera, 0, bad, height), pan(camera, bad, 0, height),
              pan(camera, 0, bad, height), zoomTo(camera, bad, 10, 10, width, height),
              zoomTo(camera, 0.9, bad, 10, width, height), zoomTo(camera, 0.9, 10, bad, width, height)})
            CHECK(isUsable(after));
        const auto spoil = [&](int field) {
            Camera c;
            double* fieldsOfCamera[] = {&c.position.x, &c.position.y,  &c.position.z, &c.target.x,
                                        &c.target.y,   &c.target.z,    &c.up.x,       &c.up.y,
                                        &c.up.z,       &c.fovYDegrees, &c.orthoHeight};
            *fieldsOfCamera[field] = bad;
            return c;
        };
        for (int field = 0; field < 11; ++field)
            CHECK_FALSE(isUsable(spoil(field)));
    }
    for (const char* text :
         {R"({"position": [1e151, 0, 0]})", R"({"fovYDegrees": 180})", R"({"orthoHeight": 0})",
          R"({"target": [0, null, 0]})", R"({"up": [0, 0, 1e999]})"})
        CHECK_FALSE(cameraFromJson(text).ok());
}

TEST_CASE("ten thousand steps of interaction keep their distance and come back", "[numerics]") {
    std::mt19937_64 random(13);
    std::uniform_real_distribution<double> unit(-1, 1);
    double worstDistance = 0, worstReturn = 0;
    for (double offset : {0.0, 5e6, 1e9}) {
        Camera camera;
        camera.target = {offset, offset, offset};
        camera.position = camera.target + Vec3d{30, -40, 25};
        double distance = length(camera.position - camera.target);
        for (int i = 0; i < 10000; ++i)
            camera = orbit(camera, 40 * unit(random), 40 * unit(random), height);
        // Each step rounds the position to a double.
        double resolution = ulpOf(camera.position) / distance + ulp;
        worstDistance = std::max(
            worstDistance, std::abs(length(camera.position - camera.target) / distance - 1) / resolution);
        Camera zoomed = camera;
        for (int i = 0; i < 5000; ++i)
            zoomed = zoomTo(zoomed, 0.99 + 0.0001 * (i % 7), 200, 300, width, height);
        CHECK(isUsable(zoomed));
        CHECK(length(zoomed.target - zoomed.position) > 0);
        Camera there = camera;
        for (int i = 0; i < 500; ++i)
            there = zoomTo(there, 0.99, 200, 300, width, height);
        for (int i = 0; i < 500; ++i)
            there = zoomTo(there, 1 / 0.99, 200, 300, width, height);
        worstReturn = std::max(worstReturn, length(there.position - camera.position) /
                                                (ulpOf(camera.position) + distance * ulp));
    }
    std::printf("interaction: after 10,000 turns the distance is off by %.0f roundings; after zooming in and "
                "out 500 times each the "
                "place by %.0f\n",
                worstDistance, worstReturn);
    CHECK(worstDistance < 10000);
    CHECK(worstReturn < 1e6);
}
