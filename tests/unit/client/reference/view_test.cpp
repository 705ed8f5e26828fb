#include "client/reference/view.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>

using namespace stipple;
using reference::Place;
using reference::Vec3l;
using reference::View;
using reference::viewOf;

namespace {

constexpr int width = 400, height = 200;
constexpr BoxD box{{-1, -2, -3}, {4, 5, 6}};

Camera cameraAt(Vec3d position, Vec3d target, Projection projection = Projection::perspective) {
    Camera camera;
    camera.projection = projection;
    camera.position = position;
    camera.target = target;
    camera.fovYDegrees = 90; // slope 1
    camera.orthoHeight = 20;
    return camera;
}

} // namespace

TEST_CASE("a perspective view puts points where the similar triangles say") {
    View view = viewOf(cameraAt({0, 0, 0}, {0, 1, 0}), width, height, box);
    Place at;
    REQUIRE(place(view, {1, 10, 2}, at));
    CHECK(at.x == Approx(200 + 100 * 1 / 10.0));
    CHECK(at.y == Approx(100 - 100 * 2 / 10.0));
    CHECK(at.distance == Approx(10));
    CHECK_FALSE(place(view, {1, -10, 2}, at));
    CHECK_FALSE(place(view, {1, 0, 2}, at));
}

TEST_CASE("an orthographic view has one scale at all distances, and all content in front") {
    View view = viewOf(cameraAt({0, 0, 0}, {0, 1, 0}, Projection::orthographic), width, height, box);
    Place near, far;
    REQUIRE(place(view, {1, -2, 2}, near)); // the nearest side of the box, behind the camera's position
    REQUIRE(place(view, {1, 5, 2}, far));
    CHECK(near.distance > 0);
    CHECK(far.distance == Approx(near.distance + 7));
    CHECK(near.x == Approx(210));
    CHECK(near.y == Approx(80));
    CHECK(far.x == Approx(near.x));
    CHECK(far.y == Approx(near.y));
    // From afar the eye stands where a perspective camera would see the target at this size: 10 away.
    View back = viewOf(cameraAt({0, -1000, 0}, {0, 500, 0}, Projection::orthographic), width, height, {});
    CHECK(static_cast<double>(back.eye.y) == Approx(490));
}

TEST_CASE("range limits leave points out") {
    View view = viewOf(cameraAt({0, 0, 0}, {0, 1, 0}), width, height, box);
    view.near = 5;
    view.far = 20;
    Place at;
    CHECK_FALSE(place(view, {0, 4.9L, 0}, at));
    CHECK(place(view, {0, 5, 0}, at));
    CHECK(place(view, {0, 20, 0}, at));
    CHECK_FALSE(place(view, {0, 20.1L, 0}, at));
}

TEST_CASE("a view agrees with the client's, which was written apart from it") {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    auto vector = [&](double size) {
        return Vec3d{unit(random) * size, unit(random) * size, unit(random) * size};
    };
    for (int i = 0; i < 500; ++i) {
        Camera camera =
            cameraAt(vector(30), vector(10), i % 2 ? Projection::perspective : Projection::orthographic);
        camera.up = i % 7 ? vector(1) : camera.target - camera.position; // now and then no hint at all
        camera.fovYDegrees = 90 + 80 * unit(random);
        camera.orthoHeight = std::exp(3 * unit(random));
        View view = viewOf(camera, width, height, box);
        ViewTransform other = viewTransform(camera, width, height, box);
        CHECK(length(view.right - other.right) < 1e-9);
        CHECK(length(view.up - other.up) < 1e-9);
        CHECK(length(view.forward - other.forward) < 1e-9);
        Vec3d point = vector(20);
        Place at;
        if (!place(view, {point.x, point.y, point.z}, at) || at.distance < 1e-3)
            continue;
        Vec3d pixels = projectToPixels(other, width, height, point);
        CHECK(at.x == Approx(pixels.x).epsilon(1e-9).margin(1e-7));
        CHECK(at.y == Approx(pixels.y).epsilon(1e-9).margin(1e-7));
        CHECK(at.distance == Approx(pixels.z).epsilon(1e-9));
    }
}

TEST_CASE("offsets of 10^12 leave no trace in a picture of millimetres") {
    // 2^40 is about 10^12: the positions are exact in double, a hundredth of a millimetre beside them is not.
    constexpr long double far = 0x1p40L;
    Camera camera = cameraAt({0x1p40, 0x1p40 - 1, 0x1p40}, {0x1p40, 0x1p40, 0x1p40});
    View view = viewOf(camera, width, height, {});
    Place at;
    REQUIRE(place(view, {far + 0.00001L, far, far}, at));
    CHECK(at.x - 200 == Approx(0.001).epsilon(0.02));
}
