// Orthographic views of content that is deep against the picture (client/render/raster_setup.hpp, "Deep
// nodes"): where float misses by up to hundreds of pixels, points are where they belong. Truth is the
// reference's view, in long double.
#include "client/core/frame_planner.hpp"
#include "client/reference/view.hpp"
#include "client/render/raster_setup.hpp"
#include "client/render/software_renderer.hpp"
#include "tests/support/gles.hpp"
#include "tests/support/test_plan.hpp"

#include <cmath>
#include <cstdio>

using namespace stipple;
using namespace stipple::test;

namespace {

constexpr int width = 1280, height = 720;

struct Scene {
    const char* name;
    Grid grid;
    RootCube cube;
    int level; // of the node that is drawn: the one that holds the target
    Vec3d target;
};

Grid millimetres(Vec3d offset) {
    return {{0.001, 0.001, 0.001}, offset};
}

const std::vector<Scene> scenes{
    {"node 2^17", millimetres({0, 0, 0}), {{0, 0, 0}, 20}, 3, {401.25, 300.5, 77.125}},
    {"UTM, node 2^24", millimetres({500000, 4800000, 0}), {{0, 0, 0}, 24}, 0, {508123.4, 4807654.3, 321.5}},
    {"UTM, node 2^31", millimetres({0, 4000000, 0}), {{0, 0, 0}, 31}, 0, {508123.4, 4807654.3, 321.5}},
    {"ECEF, root 2^36, node 2^31",
     millimetres({0, 0, 0}),
     {{-8000000000, -8000000000, -8000000000}, 36},
     5,
     {3912345.678, 613245.25, 4987654.321}},
};

// A node with points all over the picture and at all depths; their colours are their indices.
struct DeepView {
    FramePlan plan;
    std::vector<reference::Place> truth;
    double depthPixels = 0;
};

DeepView deepView(const Scene& scene, double unitsPerPixel, std::size_t count) {
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.target = scene.target;
    camera.position = scene.target - normalized(Vec3d{0.48, 0.71, -0.515}) * (1000 * unitsPerPixel);
    camera.orthoHeight = unitsPerPixel * height;

    CloudMetadata metadata;
    metadata.grid = scene.grid;
    metadata.rootCube = scene.cube;
    metadata.spacing = 1;
    Vec3i at;
    for (int axis = 0; axis < 3; ++axis)
        at[axis] = gridPosition(scene.target[axis], scene.grid.offset[axis], scene.grid.scale[axis]).cell;
    NodeKey key = scene.cube.keyOf(at, scene.level);
    Vec3i corner = scene.cube.nodeMin(key);
    int bits = scene.cube.nodeBits(scene.level);
    double side = std::ldexp(1.0, bits);
    BoxD content;
    content.extend(scene.grid.toWorld(corner));
    content.extend(
        scene.grid.toWorld({corner.x + (std::int64_t{1} << bits), corner.y + (std::int64_t{1} << bits),
                            corner.z + (std::int64_t{1} << bits)}));

    DeepView deep;
    deep.depthPixels = side * scene.grid.scale.x * std::sqrt(3.0) / unitsPerPixel;
    deep.plan.width = width;
    deep.plan.height = height;
    deep.plan.view = viewTransform(camera, width, height, content);
    deep.plan.style.sizePixels = 1;
    deep.plan.style.edl.enabled = false;
    reference::View view = reference::viewOf(camera, width, height, content);

    TestRandom random(17);
    auto signedUnit = [&] { return 2 * random.unit() - 1; };
    NodePicture picture;
    while (picture.size() < count) {
        Vec3d world = scene.target + deep.plan.view.forward * (signedUnit() * side * scene.grid.scale.x) +
                      deep.plan.view.right * (signedUnit() * width / 2 * unitsPerPixel) +
                      deep.plan.view.up * (signedUnit() * height / 2 * unitsPerPixel);
        Vec3<std::uint32_t> p;
        reference::Vec3l exact;
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis) {
            std::int64_t cell =
                gridPosition(world[axis], scene.grid.offset[axis], scene.grid.scale[axis]).cell;
            inside = inside && cell >= corner[axis] && cell - corner[axis] < (std::int64_t{1} << bits);
            p[axis] = static_cast<std::uint32_t>(cell - corner[axis]);
            exact[axis] = static_cast<long double>(scene.grid.offset[axis]) +
                          static_cast<long double>(scene.grid.scale[axis]) * static_cast<long double>(cell);
        }
        reference::Place place;
        if (!inside || !reference::place(view, exact, place))
            continue;
        std::uint16_t index = static_cast<std::uint16_t>(picture.size());
        picture.positions.push_back(p);
        picture.colour.insert(picture.colour.end(),
                              {static_cast<std::uint16_t>(index & 255),
                               static_cast<std::uint16_t>(index >> 8), std::uint16_t{200}});
        deep.truth.push_back(place);
    }
    auto node = std::make_shared<ResidentNode>(
        packNode(key, bits, static_cast<std::uint32_t>(count), picture, PictureColour::rgb, true));
    deep.plan.nodes.push_back(planNode(node, node->pointCount, metadata, deep.plan.view.eye));
    return deep;
}

// x and y of a point in pixels from the lower left corner, as the rasterizers' integers have them; near
// `truth`.
double integerPlace(const std::array<std::uint32_t, 3>& low, const std::array<std::uint32_t, 3>& high,
                    std::uint32_t origin, int fractionBits, const std::array<std::int32_t, 3>& steps,
                    double truth) {
    std::uint32_t sum = origin;
    for (std::size_t i = 0; i < 3; ++i) {
        auto rest = static_cast<std::int16_t>(steps[i] & 0xFFFF); // two's complement
        sum += static_cast<std::uint32_t>(rest) * low[i] +
               static_cast<std::uint32_t>((steps[i] - rest) >> 16) * high[i];
    }
    double whole = std::floor(truth);
    auto base = static_cast<std::uint32_t>(static_cast<std::int64_t>(whole)) << fractionBits;
    return whole + std::ldexp(static_cast<std::int32_t>(sum - base), -fractionBits);
}

double largestError(const DeepView& deep, double& floatError) {
    const DrawNode& node = deep.plan.nodes[0];
    RasterNode raster = rasterNode(deep.plan, node);
    REQUIRE(raster.deep);
    double largest = 0;
    for (std::size_t k = 0; k < deep.truth.size(); ++k) {
        Vec3<std::uint32_t> p = positionOf(*node.node, k);
        std::array<std::int32_t, 3> s{};
        float x = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            s[i] = static_cast<std::int32_t>(p[static_cast<int>(i)] -
                                             static_cast<std::uint32_t>(raster.cell[i]));
            x += (static_cast<float>(s[i]) - raster.fraction[i]) * raster.rowX[i];
        }
        double trueX = deep.truth[k].x, trueY = height - deep.truth[k].y;
        double placeX =
            integerPlace(raster.lowX, raster.highX, raster.originX, raster.fractionBits, s, trueX);
        double placeY =
            integerPlace(raster.lowY, raster.highY, raster.originY, raster.fractionBits, s, trueY);
        largest = std::max(largest, std::hypot(placeX - trueX, placeY - trueY));
        floatError = std::max(floatError, std::abs(double{x} + width / 2.0 - trueX));
    }
    return largest;
}

// What is allowed: 0.006 pixel an axis, twice that for each doubling of the reach beyond 2^29 pixels.
double allowed(const DeepView& deep) {
    return 0.009 * std::max(1.0, deep.depthPixels * 2 / 0x1p29);
}

// Pixels that show a point which does not belong there, by more than `slack` pixels; `shown` counts all that
// show one.
std::size_t misplaced(const Image& image, const DeepView& deep, double slack, std::size_t& shown) {
    std::size_t wrong = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::uint8_t* p = &image.rgba[4 * static_cast<std::size_t>(y * width + x)];
            if (p[2] != 200)
                continue;
            ++shown;
            const reference::Place& truth = deep.truth.at(p[0] | std::size_t{p[1]} << 8);
            wrong += std::abs(truth.x - x - 0.5) > 0.5 + slack || std::abs(truth.y - y - 0.5) > 0.5 + slack;
        }
    return wrong;
}

} // namespace

TEST_CASE("points of deep orthographic views are where they belong", "[software][numerics]") {
    auto renderer = SoftwareRenderer::create(2);
    for (const Scene& scene : scenes)
        for (double unitsPerPixel : {0.001, 0.013, 0.11}) {
            DeepView deep = deepView(scene, unitsPerPixel, 5000);
            if (deep.depthPixels < 10000)
                continue;
            INFO(scene.name << ", " << unitsPerPixel << " units a pixel");
            double floatError = 0, error = largestError(deep, floatError);
            std::printf("deep view, %s, %g units a pixel: %.2g pixels deep, off by at most %.2g pixels "
                        "(float: %.2g)\n",
                        scene.name, unitsPerPixel, deep.depthPixels, error, floatError);
            CHECK(error < allowed(deep));
            for (double size : {1.0, 1.001}) { // single pixels, and squares of a size that is rounded to one
                deep.plan.style.sizePixels = size;
                deep.plan.style.shape = size == 1 ? PointShape::circle : PointShape::square;
                std::size_t shown = 0;
                CHECK(misplaced(renderer->render(deep.plan), deep, allowed(deep) + 1.0 / 128, shown) == 0);
                CHECK(shown > 4500); // some lie behind another
            }
        }
}

TEST_CASE("software and GLES place points of deep orthographic views alike", "[gles]") {
    auto* context = eglContext();
    if (!context)
        return;
    auto gles = GlesRenderer::create();
    REQUIRE(gles.ok());
    for (const Scene& scene : scenes)
        for (double size : {1.0, 3.0}) {
            DeepView deep = deepView(scene, 0.002, 3000);
            INFO(scene.name);
            deep.plan.style.sizePixels = size;
            Image software = SoftwareRenderer::create(1)->render(deep.plan);
            Image image = glesPicture(*context, **gles, deep.plan);
            std::size_t differing = 0;
            for (std::size_t i = 0; i < image.rgba.size(); i += 4)
                differing += image.rgba[i] != software.rgba[i] || image.rgba[i + 1] != software.rgba[i + 1];
            CHECK(differing <= (isExact(*context)
                                    ? 2
                                    : allowedPixels(*context, image.rgba.size() / 4))); // a depth step or two
        }
}
