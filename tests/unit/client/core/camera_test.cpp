#include "client/core/camera.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

namespace {

constexpr int width = 1280, height = 720;

BoxD boxOf(Vec3d min, Vec3d max) {
    BoxD box;
    box.extend(min);
    box.extend(max);
    return box;
}

std::vector<Vec3d> cornersOf(const BoxD& box) {
    std::vector<Vec3d> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back(
            {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z});
    return corners;
}

void checkAxes(const ViewTransform& view) {
    CHECK(length(view.right) == Approx(1).margin(1e-14));
    CHECK(length(view.up) == Approx(1).margin(1e-14));
    CHECK(length(view.forward) == Approx(1).margin(1e-14));
    CHECK(length(cross(view.right, view.up) + view.forward) < 1e-14);
}

double distanceInPixels(Vec3d a, Vec3d b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

Camera someCamera(Projection projection) {
    Camera camera;
    camera.projection = projection;
    camera.position = {12, -30, 25};
    camera.target = {1, 2, 3};
    camera.orthoHeight = 18;
    return camera;
}

const BoxD unitBox = boxOf({-1, -1, -1}, {1, 1, 1});

} // namespace

TEST_CASE("the axes are orthonormal and right-handed for any direction and any hint") {
    std::vector<Vec3d> directions{{0, 1, 0}, {0, 0, -1}, {0, 0, 1}, {1, 1, -1}, {1e-9, 0, -1}, {-3, 2, 0.1}};
    std::vector<Vec3d> hints{{0, 0, 1}, {0, 1, 0}, {0, 0, -5}, {1, 1, 1}, {0, 0, 0}};
    for (Vec3d direction : directions)
        for (Vec3d hint : hints) {
            Camera camera;
            camera.position = {3, 4, 5};
            camera.target = camera.position + direction;
            camera.up = hint;
            checkAxes(viewTransform(camera, width, height, unitBox));
        }
}

TEST_CASE("a camera that stands on its target still has axes") {
    Camera camera;
    camera.target = camera.position;
    ViewTransform view = viewTransform(camera, width, height, unitBox);
    checkAxes(view);
    CHECK(view.near > 0);
    CHECK(view.near < view.far);
}

TEST_CASE("looking straight down, north is up") {
    Camera camera = namedCamera(NamedView::top, unitBox, 1.5);
    ViewTransform view = viewTransform(camera, width, height, unitBox);
    CHECK(view.right == Vec3d{1, 0, 0});
    CHECK(view.up == Vec3d{0, 1, 0});
    CHECK(view.forward == Vec3d{0, 0, -1});
}

TEST_CASE("near and far enclose all content in front of the camera") {
    auto projection = GENERATE(Projection::perspective, Projection::orthographic);
    // outside, inside, touching, very far away, content behind, a single point, planet-sized
    struct Scene {
        Vec3d position, target;
        BoxD content;
    };
    auto scene =
        GENERATE(Scene{{0, -10, 0}, {0, 0, 0}, boxOf({-1, -1, -1}, {1, 1, 1})},
                 Scene{{0.5, 0.5, 0}, {1, 1, 0}, boxOf({-1, -1, -1}, {1, 1, 1})},
                 Scene{{0, -1, 0}, {0, 0, 0}, boxOf({-1, -1, -1}, {1, 1, 1})},
                 Scene{{0, -1e12, 0}, {0, 0, 0}, boxOf({-1, -1, -1}, {1, 1, 1})},
                 Scene{{0, 10, 0}, {0, 20, 0}, boxOf({-1, -1, -1}, {1, 1, 1})},
                 Scene{{0, -1, 0}, {0, 0, 0}, boxOf({0, 0, 0}, {0, 0, 0})},
                 Scene{{4e6, 4e6, 4e6}, {4e6, 4e6, 4e6 - 1e-3}, boxOf({-7e6, -7e6, -7e6}, {7e6, 7e6, 7e6})});
    Camera camera;
    camera.projection = projection;
    camera.position = scene.position;
    camera.target = scene.target;
    ViewTransform view = viewTransform(camera, width, height, scene.content);
    CHECK(view.near > 0);
    CHECK(view.near < view.far);
    CHECK(view.far / view.near < 0x1p32);
    for (Vec3d corner : cornersOf(scene.content)) {
        double depth = dot(corner - view.eye, view.forward);
        if (projection == Projection::orthographic)
            CHECK(depth > view.near);
        if (depth > 0) {
            CHECK(depth < view.far);
            CHECK((depth > view.near || depth < view.far * 0x1p-30));
        }
    }
}

TEST_CASE("an empty content gives a usable depth range") {
    for (Projection projection : {Projection::perspective, Projection::orthographic}) {
        ViewTransform view = viewTransform(someCamera(projection), width, height, BoxD{});
        CHECK(view.near > 0);
        CHECK(view.near < view.far);
    }
}

TEST_CASE("moving the eye of an orthographic view back changes no pixel") {
    Camera camera = someCamera(Projection::orthographic);
    ViewTransform small = viewTransform(camera, width, height, unitBox);
    ViewTransform large = viewTransform(camera, width, height, boxOf({-1e3, -1e3, -1e3}, {1e3, 1e3, 1e3}));
    CHECK(length(large.eye - small.eye) > 100);
    for (Vec3d corner : cornersOf(unitBox))
        CHECK(distanceInPixels(projectToPixels(small, width, height, corner),
                               projectToPixels(large, width, height, corner)) < 1e-8);
}

TEST_CASE("a named view shows all of its content and fills the picture, centred, up to its margin") {
    auto name = GENERATE(NamedView::top, NamedView::front, NamedView::side, NamedView::iso);
    auto projection = GENERATE(Projection::perspective, Projection::orthographic);
    auto content =
        GENERATE(boxOf({-1, -1, -1}, {1, 1, 1}), boxOf({0, 0, 0}, {100, 1, 2}),
                 boxOf({5e5, 4e6, 100}, {5e5 + 3000, 4e6 + 2000, 400}), boxOf({0, 0, 0}, {1, 0, 0}));
    int w = GENERATE(1280, 400);
    Camera camera = namedCamera(name, content, static_cast<double>(w) / height, projection);
    REQUIRE(isUsable(camera));
    ViewTransform view = viewTransform(camera, w, height, content);
    double left = HUGE_VAL, right = -HUGE_VAL, top = HUGE_VAL, bottom = -HUGE_VAL;
    for (Vec3d corner : cornersOf(content)) {
        Vec3d pixel = projectToPixels(view, w, height, corner);
        CHECK(pixel.z > view.near);
        CHECK(pixel.z < view.far);
        left = std::min(left, pixel.x);
        right = std::max(right, pixel.x);
        top = std::min(top, pixel.y);
        bottom = std::max(bottom, pixel.y);
    }
    CHECK(left >= 0);
    CHECK(right <= w);
    CHECK(top >= 0);
    CHECK(bottom <= height);
    bool isSeenEndOn = name == NamedView::side && content.max.y == content.min.y; // a line is a point then
    CHECK(std::max((right - left) / w, (bottom - top) / height) ==
          Approx(isSeenEndOn ? 0 : 0.96).epsilon(1e-6));
    CHECK(std::abs((left + right) / 2 - w / 2.0) < 0.01 * std::max(right - left, 1.0));
    CHECK(std::abs((top + bottom) / 2 - height / 2.0) < 0.01 * std::max(bottom - top, 1.0));
    // Turning goes around the content: the target is at its depth.
    CHECK(dot(camera.target - (content.min + content.max) * 0.5, view.forward) == Approx(0).margin(1e-6));
}

TEST_CASE("a named view of a point or of nothing is usable") {
    for (Projection projection : {Projection::perspective, Projection::orthographic}) {
        Camera ofPoint = namedCamera(NamedView::iso, boxOf({3, 3, 3}, {3, 3, 3}), 1.5, projection);
        CHECK(isUsable(ofPoint));
        Vec3d pixel = projectToPixels(viewTransform(ofPoint, width, height, boxOf({3, 3, 3}, {3, 3, 3})),
                                      width, height, {3, 3, 3});
        CHECK(pixel.x == Approx(width / 2.0));
        CHECK(pixel.y == Approx(height / 2.0));
        CHECK(isUsable(namedCamera(NamedView::iso, BoxD{}, 1.5, projection)));
    }
}

TEST_CASE("the point under the pointer stays there while zooming") {
    auto projection = GENERATE(Projection::perspective, Projection::orthographic);
    double factor = GENERATE(0.5, 0.9, 1.1, 4.0);
    Camera camera = someCamera(projection);
    ViewTransform view = viewTransform(camera, width, height, unitBox);
    double units = unitsPerPixel(camera, height);
    for (double x : {0.0, 200.5, 640.0, 1279.0})
        for (double y : {0.0, 100.25, 719.0}) {
            Vec3d under = camera.target + view.right * ((x - width / 2.0) * units) +
                          view.up * ((height / 2.0 - y) * units);
            Vec3d before = projectToPixels(view, width, height, under);
            REQUIRE(distanceInPixels(before, {x, y, 0}) < 1e-9);
            Camera zoomed = zoomTo(camera, factor, x, y, width, height);
            Vec3d after =
                projectToPixels(viewTransform(zoomed, width, height, unitBox), width, height, under);
            CHECK(distanceInPixels(after, {x, y, 0}) < 1e-6);
            CHECK(unitsPerPixel(zoomed, height) == Approx(units * factor));
        }
}

TEST_CASE("zooming in and out again ends where it began") {
    Camera camera = someCamera(Projection::perspective);
    Camera there = zoomTo(camera, 0.25, 100, 200, width, height);
    Camera back = zoomTo(there, 4, 100, 200, width, height);
    CHECK(length(back.position - camera.position) < 1e-12);
    CHECK(length(back.target - camera.target) < 1e-12);
}

TEST_CASE("zooming stops before the direction of view dissolves") {
    Camera camera = someCamera(Projection::perspective);
    camera.position = camera.position + Vec3d{1e9, 1e9, 0};
    camera.target = camera.target + Vec3d{1e9, 1e9, 0};
    for (int i = 0; i < 200; ++i)
        camera = zoomTo(camera, 0.5, 640, 360, width, height);
    CHECK(isUsable(camera));
    CHECK(length(camera.target - camera.position) > 1e-5);
    CHECK(zoomTo(camera, 0, 1, 1, width, height) == camera);
    CHECK(zoomTo(camera, -1, 1, 1, width, height) == camera);
    CHECK(zoomTo(camera, NAN, 1, 1, width, height) == camera);
}

TEST_CASE("a pan moves the target by the pixels of the drag") {
    auto projection = GENERATE(Projection::perspective, Projection::orthographic);
    Camera camera = someCamera(projection);
    Camera moved = pan(camera, 37, -21, height);
    Vec3d pixel = projectToPixels(viewTransform(moved, width, height, unitBox), width, height, camera.target);
    CHECK(distanceInPixels(pixel, {width / 2.0 + 37, height / 2.0 - 21, 0}) < 1e-9);
    CHECK(length((moved.target - moved.position) - (camera.target - camera.position)) < 1e-12);
}

TEST_CASE("an orbit keeps target, distance and horizon") {
    Camera camera = someCamera(Projection::perspective);
    double distance = length(camera.target - camera.position);
    for (int i = 0; i < 50; ++i)
        camera = orbit(camera, 31, i % 2 ? 40 : -25, height);
    CHECK(camera.target == Vec3d{1, 2, 3});
    CHECK(length(camera.target - camera.position) == Approx(distance));
    CHECK(std::abs(viewTransform(camera, width, height, unitBox).right.z) < 1e-12);
}

TEST_CASE("a viewport's height of drag is half a turn, and as much back is none") {
    Camera camera = someCamera(Projection::perspective);
    Camera half = orbit(camera, height, 0, height);
    Vec3d before = camera.position - camera.target, after = half.position - half.target;
    CHECK(after.x == Approx(-before.x));
    CHECK(after.y == Approx(-before.y));
    CHECK(after.z == Approx(before.z));
    CHECK(length(orbit(half, -height, 0, height).position - camera.position) < 1e-9);
}

TEST_CASE("a drag moves the near side of the content with the pointer") {
    Camera camera = namedCamera(NamedView::front, unitBox, 1.5);
    auto pixelOfNearSide = [&](const Camera& seen) {
        return projectToPixels(viewTransform(seen, width, height, unitBox), width, height, {0, -1, 0});
    };
    CHECK(pixelOfNearSide(orbit(camera, 20, 0, height)).x > width / 2.0);
    CHECK(pixelOfNearSide(orbit(camera, 0, 20, height)).y > height / 2.0);
}

TEST_CASE("an orbit stops short of the pole and leaves it again") {
    Camera camera = someCamera(Projection::perspective);
    for (int i = 0; i < 20; ++i)
        camera = orbit(camera, 5, 200, height);
    checkAxes(viewTransform(camera, width, height, unitBox));
    CHECK(normalized(camera.target - camera.position).z == Approx(-1).epsilon(1e-6));
    Camera left = orbit(camera, 0, -height / 4.0, height);
    CHECK(normalized(left.target - left.position).z == Approx(-std::sqrt(0.5)).epsilon(1e-3));
    // From exactly above, too, a sideways drag turns the picture.
    Camera above = namedCamera(NamedView::top, unitBox, 1.5);
    ViewTransform turned = viewTransform(orbit(above, height / 2.0, 0, height), width, height, unitBox);
    CHECK(turned.right.y == Approx(-1).epsilon(1e-6));
}

TEST_CASE("another projection keeps the size and place of what lies at the target's depth") {
    auto from = GENERATE(Projection::perspective, Projection::orthographic);
    auto to = GENERATE(Projection::perspective, Projection::orthographic);
    Camera camera = someCamera(from);
    Camera switched = withProjection(camera, to);
    CHECK(switched.projection == to);
    CHECK(unitsPerPixel(switched, height) == Approx(unitsPerPixel(camera, height)));
    ViewTransform before = viewTransform(camera, width, height, unitBox);
    ViewTransform after = viewTransform(switched, width, height, unitBox);
    CHECK(length(after.forward - before.forward) < 1e-12);
    for (double x : {-3.0, 0.0, 5.0})
        for (double y : {-2.0, 4.0}) {
            Vec3d point = camera.target + before.right * x + before.up * y;
            CHECK(distanceInPixels(projectToPixels(before, width, height, point),
                                   projectToPixels(after, width, height, point)) < 1e-9);
        }
    Camera back = withProjection(switched, from);
    CHECK(length(back.target - camera.target) < 1e-12);
    CHECK(unitsPerPixel(back, height) == Approx(unitsPerPixel(camera, height)));
}

TEST_CASE("a camera that stands on its target has no height of view to switch to") {
    Camera camera;
    camera.position = camera.target;
    CHECK(withProjection(camera, Projection::orthographic) == camera);
}

TEST_CASE("cameras with impossible numbers are not usable") {
    Camera camera;
    CHECK(isUsable(camera));
    for (auto spoil : {+[](Camera& c) { c.position.x = NAN; }, +[](Camera& c) { c.target.z = HUGE_VAL; },
                       +[](Camera& c) { c.fovYDegrees = 0; }, +[](Camera& c) { c.fovYDegrees = 180; },
                       +[](Camera& c) { c.orthoHeight = 0; }, +[](Camera& c) { c.orthoHeight = NAN; }}) {
        Camera bad = camera;
        spoil(bad);
        CHECK_FALSE(isUsable(bad));
    }
}
