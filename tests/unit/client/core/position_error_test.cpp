// How far drawn points are from where they belong, in pixels. The way of a point through the rasterizers is
// repeated here in float, step by step (client/render/raster_setup.hpp: the rows of the view scaled to
// pixels, float(p - cell) - fraction, three products, the division), up to the snapping that both of them
// share; the reference is long double from the world coordinates on, and shares none of it.
#include "client/core/camera.hpp"
#include "client/core/frame_planner.hpp"

#include <catch2/catch.hpp>

#include <cstdio>
#include <random>

using namespace stipple;

namespace {

constexpr int width = 1920, height = 1080;
using Real = long double;

struct Scene {
    const char* name;
    Grid grid;
    RootCube cube;
    int level; // of the node that is drawn; its coordinates are those that hold `target`
    Vec3d target;
};

struct PixelF {
    float x, y, depth;
};

PixelF drawnPixel(const ViewTransform& view, const DrawNode& node, Vec3<std::uint32_t> p) {
    bool perspective = view.projection == Projection::perspective;
    double halfHeight = perspective ? view.tanHalfFovY : view.halfHeight;
    double focalX = width / (2 * halfHeight * view.aspect), focalY = height / (2 * halfHeight);
    float r[3], rowX[3], rowY[3], rowD[3];
    for (int axis = 0; axis < 3; ++axis) {
        auto i = static_cast<std::size_t>(axis);
        rowX[axis] = static_cast<float>(view.right[axis] * node.scale[axis] * focalX);
        rowY[axis] = static_cast<float>(view.up[axis] * node.scale[axis] * focalY);
        rowD[axis] = static_cast<float>(view.forward[axis] * node.scale[axis]);
        auto steps = static_cast<std::int32_t>(p[axis] - static_cast<std::uint32_t>(node.cameraCell[i]));
        r[axis] = static_cast<float>(steps) - node.cameraFraction[i];
    }
    float x = r[0] * rowX[0] + r[1] * rowX[1] + r[2] * rowX[2];
    float y = r[0] * rowY[0] + r[1] * rowY[1] + r[2] * rowY[2];
    float d = r[0] * rowD[0] + r[1] * rowD[1] + r[2] * rowD[2];
    if (perspective) {
        x /= d;
        y /= d;
    }
    return {x, y, d};
}

struct PixelR {
    Real x, y, depth;
};

PixelR truePixel(const Camera& camera, const ViewTransform& view, const Grid& grid, Vec3i p) {
    Real relative[3], x = 0, y = 0, d = 0;
    for (int axis = 0; axis < 3; ++axis) {
        relative[axis] = static_cast<Real>(grid.offset[axis]) +
                         static_cast<Real>(grid.scale[axis]) * static_cast<Real>(p[axis]) -
                         static_cast<Real>(camera.position[axis]);
        x += relative[axis] * static_cast<Real>(view.right[axis]);
        y += relative[axis] * static_cast<Real>(view.up[axis]);
        d += relative[axis] * static_cast<Real>(view.forward[axis]);
    }
    bool perspective = view.projection == Projection::perspective;
    Real half = perspective ? static_cast<Real>(view.tanHalfFovY) * d : static_cast<Real>(view.halfHeight);
    Real focal = height / (2 * half);
    return {x * focal, y * focal, d};
}

// A node's point nearest to a world position.
bool nearestPoint(const Scene& scene, const NodeKey& key, Vec3d world, Vec3<std::uint32_t>& p, Vec3i& grid) {
    Vec3i corner = scene.cube.nodeMin(key);
    std::int64_t side = std::int64_t{1} << scene.cube.nodeBits(key.level);
    for (int axis = 0; axis < 3; ++axis) {
        GridPosition at = gridPosition(world[axis], scene.grid.offset[axis], scene.grid.scale[axis]);
        std::int64_t in = at.cell - corner[axis];
        if (in < 0 || in >= side)
            return false;
        p[axis] = static_cast<std::uint32_t>(in);
        grid[axis] = at.cell;
    }
    return true;
}

// The largest error over points all over the picture and from near to far, in one node.
double largestError(const Scene& scene, Projection projection, double unitsPerPixelAtTarget) {
    Camera camera;
    camera.projection = projection;
    double tanHalf = std::tan(camera.fovYDegrees / 2 * 3.14159265358979323846 / 180);
    double distance = unitsPerPixelAtTarget * height / (2 * tanHalf);
    camera.target = scene.target;
    camera.position = scene.target - normalized(Vec3d{0.48, 0.71, -0.515}) * distance;
    camera.orthoHeight = unitsPerPixelAtTarget * height;

    GridPosition at[3];
    for (int axis = 0; axis < 3; ++axis)
        at[axis] = gridPosition(scene.target[axis], scene.grid.offset[axis], scene.grid.scale[axis]);
    NodeKey key = scene.cube.keyOf({at[0].cell, at[1].cell, at[2].cell}, scene.level);
    CloudMetadata metadata;
    metadata.grid = scene.grid;
    metadata.rootCube = scene.cube;
    metadata.spacing = 1;
    auto resident = std::make_shared<ResidentNode>();
    resident->key = key;
    resident->nodeBits = scene.cube.nodeBits(scene.level);
    REQUIRE(resident->nodeBits <= maxNodeBits);
    BoxD content;
    Vec3i corner = scene.cube.nodeMin(key);
    std::int64_t side = std::int64_t{1} << resident->nodeBits;
    content.extend(scene.grid.toWorld(corner));
    content.extend(scene.grid.toWorld({corner.x + side, corner.y + side, corner.z + side}));
    ViewTransform view = viewTransform(camera, width, height, content);
    DrawNode node = planNode(resident, 0, metadata, view.eye);

    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> unit(-1, 1);
    double largest = 0;
    int tried = 0, seen = 0;
    for (; tried < 200'000 && seen < 4000; ++tried) {
        // A ray through the picture, and a distance along it from a hundredth to a hundred times.
        double depth = distance * std::pow(10.0, 2 * unit(random));
        double halfY = projection == Projection::perspective ? tanHalf * depth : view.halfHeight;
        Vec3d world = camera.position + view.forward * depth +
                      view.right * (unit(random) * halfY * view.aspect) + view.up * (unit(random) * halfY);
        Vec3<std::uint32_t> p;
        Vec3i grid;
        if (!nearestPoint(scene, key, world, p, grid))
            continue;
        PixelR truth = truePixel(camera, view, scene.grid, grid);
        if (std::abs(truth.x) > width / 2 || std::abs(truth.y) > height / 2)
            continue;
        // Closer to the eye than a few steps of the grid a point covers the picture anyway.
        if (projection == Projection::perspective && truth.depth < 8 * scene.grid.scale.x)
            continue;
        PixelF drawn = drawnPixel(view, node, p);
        ++seen;
        largest = std::max(largest, static_cast<double>(std::hypot(static_cast<Real>(drawn.x) - truth.x,
                                                                   static_cast<Real>(drawn.y) - truth.y)));
    }
    INFO(scene.name << ", " << unitsPerPixelAtTarget << " units a pixel: " << seen << " points of " << tried);
    CHECK(seen >= 100);
    return largest;
}

Grid gridOf(double scale, Vec3d offset) {
    return {{scale, scale, scale}, offset};
}

// `nodeBits` 31 and 24: far beyond the 21 bits of the position words; roots of 2^36 and 2^52 steps are
// wider than any node that holds points.
const std::vector<Scene> scenes{
    {"near the origin, node 2^17", gridOf(0.001, {0, 0, 0}), {{0, 0, 0}, 20}, 3, {401.25, 300.5, 77.125}},
    {"UTM, node 2^24", gridOf(0.001, {500000, 4800000, 0}), {{0, 0, 0}, 24}, 0, {508123.4, 4807654.3, 321.5}},
    {"UTM, node 2^31", gridOf(0.001, {0, 4000000, 0}), {{0, 0, 0}, 31}, 0, {508123.4, 4807654.3, 321.5}},
    {"ECEF, root 2^36, node 2^31",
     gridOf(0.001, {0, 0, 0}),
     {{-8000000000, -8000000000, -8000000000}, 36},
     5,
     {3912345.678, 613245.25, 4987654.321}},
    {"offset 10^9, 1 mm, node 2^20",
     gridOf(0.001, {1e9, -1e9, 1e9}),
     {{0, 0, 0}, 30},
     10,
     {1e9 + 123456.7, -1e9 + 765432.1, 1e9 + 4321.5}},
    {"offset 10^9, 1 mm, node 2^30",
     gridOf(0.001, {1e9, -1e9, 1e9}),
     {{0, 0, 0}, 30},
     0,
     {1e9 + 123456.7, -1e9 + 765432.1, 1e9 + 4321.5}},
    {"planet, root 2^52 of 1 nm, node 2^31",
     gridOf(1e-9, {0, 0, 0}),
     {{0, 0, 0}, 52},
     21,
     {1.5, 2.25, 3.125}},
};

// From the whole cloud in the picture's height to 1 mm a pixel, in steps of ten.
std::vector<double> zoomsOf(const Scene& scene) {
    double side = std::ldexp(scene.grid.scale.x, scene.cube.nodeBits(scene.level));
    std::vector<double> zooms;
    for (double units = side / height; units > 0.001; units /= 10)
        zooms.push_back(units);
    zooms.push_back(0.001);
    return zooms;
}

} // namespace

TEST_CASE("a drawn point is within 0.01 pixel of where it belongs in perspective") {
    double largest = 0;
    for (const Scene& scene : scenes) {
        std::string line;
        for (double zoom : zoomsOf(scene)) {
            double error = largestError(scene, Projection::perspective, zoom);
            CHECK(error < 0.01);
            largest = std::max(largest, error);
            char cell[64];
            std::snprintf(cell, sizeof cell, "  %.3g: %.2e", zoom, error);
            line += cell;
        }
        std::printf("position error, perspective, %s (units a pixel: pixels)%s\n", scene.name, line.c_str());
    }
    std::printf("position error, perspective, largest: %.2e pixels\n", largest);
}

// All points of an orthographic view are as far from the eye as the content is deep, however small the
// picture's section is: float then resolves 2^-24 of that depth. Where that shows, this is only the estimate
// that the rasterizers' integers start from (client/render/raster_setup.hpp, "Deep nodes";
// deep_views_test.cpp).
TEST_CASE(
    "a drawn point's floats in an orthographic view are off by at most 2^-23 of the depth of the content") {
    for (const Scene& scene : scenes) {
        std::string line;
        double side = std::ldexp(scene.grid.scale.x, scene.cube.nodeBits(scene.level));
        for (double zoom : zoomsOf(scene)) {
            double error = largestError(scene, Projection::orthographic, zoom);
            double depthPixels = side * std::sqrt(3.0) / zoom;
            CHECK(error < 3e-4 + depthPixels * 0x1p-23);
            char cell[64];
            std::snprintf(cell, sizeof cell, "  %.3g: %.2e", zoom, error);
            line += cell;
        }
        std::printf("position error, orthographic, %s (units a pixel: pixels)%s\n", scene.name, line.c_str());
    }
}

// Every offset with every step of the grid, in nodes of 2^20 and 2^31 steps: the whole node in the picture,
// and one step a pixel. Where the coordinates' own doubles can't tell the camera from its target there is
// nothing to draw.
TEST_CASE(
    "a drawn point is within 0.01 pixel of where it belongs for offsets to 10^12 and steps of 10^-9 to 10^3",
    "[numerics]") {
    double largest = 0;
    int drawn = 0;
    for (double offset : {0.0, 1e3, 1e6, 1e9, 1e12})
        for (double step : {1e-9, 1e-6, 1e-3, 1.0, 1e3})
            for (int bits : {20, 31}) {
                double side = std::ldexp(step, bits);
                Vec3d middle{offset + side * 0.4, -offset + side * 0.6, offset / 7 + side * 0.5};
                Scene scene{
                    "grid", gridOf(step, {offset, -offset, offset / 7}), {{0, 0, 0}, bits}, 0, middle};
                for (double zoom : {side / height, step}) {
                    if (zoom * height < 1e5 * offset * 0x1p-52)
                        continue;
                    INFO("offset " << offset << ", step " << step << ", 2^" << bits << ", " << zoom
                                   << " units a pixel");
                    double error = largestError(scene, Projection::perspective, zoom);
                    CHECK(error < 0.01);
                    largest = std::max(largest, error);
                    ++drawn;
                }
            }
    std::printf(
        "position error, perspective, offsets to 10^12, steps 10^-9 to 10^3: %d views, largest %.2e pixels\n",
        drawn, largest);
    CHECK(drawn > 60);
}

// LAS 1.4 holds coordinates in signed 32 bits: a cloud from one end to the other is 2^32 steps wide, and has
// nodes of 2^31.
TEST_CASE("a drawn point is within 0.01 pixel of where it belongs at the ends of LAS's integers",
          "[numerics]") {
    double largest = 0;
    for (double end : {-2147483000.0, 2147483000.0}) {
        Scene scene{"LAS",
                    gridOf(0.001, {0, 0, 0}),
                    {{-2147483648LL, -2147483648LL, -2147483648LL}, 32},
                    1,
                    {end * 0.001, end * 0.001, end * 0.001}};
        for (double zoom : {1000.0, 1.0, 0.001})
            largest = std::max(largest, largestError(scene, Projection::perspective, zoom));
    }
    std::printf("position error, perspective, ends of 32-bit integers: largest %.2e pixels\n", largest);
    CHECK(largest < 0.01);
}

// From 10^-4 units before a point inside a node of nanometres to 10^8 units away from one of metres.
TEST_CASE("a drawn point is within 0.01 pixel of where it belongs from 10^-4 to 10^8 units away",
          "[numerics]") {
    double largest = 0;
    for (auto [step, distance] :
         {std::pair{1e-9, 1e-4}, {1e-9, 1e-2}, {1e-3, 1.0}, {1e-3, 1e3}, {1.0, 1e5}, {1.0, 1e8}}) {
        double side = std::ldexp(step, 31);
        Scene scene{
            "distance", gridOf(step, {0, 0, 0}), {{0, 0, 0}, 31}, 0, {side * 0.51, side * 0.47, side * 0.53}};
        double tanHalf = std::tan(30 * 3.14159265358979323846 / 180);
        double error = largestError(scene, Projection::perspective, distance * 2 * tanHalf / height);
        INFO(distance << " units away");
        CHECK(error < 0.01);
        largest = std::max(largest, error);
    }
    std::printf(
        "position error, perspective, cameras 10^-4 to 10^8 units from their target: largest %.2e pixels\n",
        largest);
}
