// Points that grow where finer nodes are awaited: sizes against looking at all nodes, and the pictures of
// both rasterizers. Tolerances of pictures: as in picture_match_test.cpp.
#include "client/measure/pixel_error.hpp"
#include "client/render/drawn_octree.hpp"
#include "client/render/software_renderer.hpp"
#include "client/render/software_transform.hpp"
#include "tests/support/gles.hpp"
#include "tests/support/test_plan.hpp"

#include <algorithm>
#include <cmath>

using namespace stipple;
using namespace stipple::test;

namespace {

struct Scene {
    std::vector<TestNode> all, drawn;
    FramePlan plan; // of those that are drawn; the others are awaited
};

// Of an octree the nodes that `isDrawn` says; the others are awaited.
template <class IsDrawn>
Scene sceneOf(std::uint32_t pointsPerNode, Projection projection, const Style& style,
              const IsDrawn& isDrawn) {
    Scene scene;
    scene.all = randomOctree(21, 3, pointsPerNode, 12, {-5, -5, -5}, 10.0 / 4096);
    std::vector<AwaitedNode> awaited;
    for (std::size_t i = 0; i < scene.all.size(); ++i)
        if (isDrawn(i))
            scene.drawn.push_back(scene.all[i]);
        else
            awaited.push_back({0, scene.all[i].key});
    scene.plan = testPlan(scene.drawn, octreeView(projection), style);
    for (AwaitedNode& one : awaited)
        one.cloud = scene.plan.nodes.front().cloud;
    scene.plan.awaited = awaited;
    return scene;
}

Style fixedStyle(double pixels = 2) {
    Style style;
    style.sizePixels = pixels;
    style.sizeSpacings = 1.1;
    style.edl.enabled = false;
    return style;
}

// Sizes of a node's points in 1/64 pixel, as the software renderer has them, with where each was placed.
struct Placed {
    std::vector<int> size64;
    std::vector<std::int32_t> x;
};
Placed softwareSizes(const FramePlan& plan, std::size_t index) {
    RasterFrame frame = rasterFrame(plan);
    REQUIRE(frame.growing);
    const DrawNode& node = plan.nodes[index];
    RasterNode raster = rasterNode(plan, node);
    DrawnOctree octree = drawnOctree(plan);
    Placed placed;
    Block block;
    for (std::size_t first = 0; first < node.pointCount; first += blockPoints) {
        std::size_t count = std::min<std::size_t>(blockPoints, node.pointCount - first);
        Words words = wordsFrom(*node.node, first);
        fillFineness(octree.words.data(), octree.places[index], *node.node, words, count, block);
        transformFor(frame, raster, sizingOf(frame))(frame, raster, words, count, block);
        placed.size64.insert(placed.size64.end(), block.size64.begin(), block.size64.begin() + count);
        placed.x.insert(placed.x.end(), block.x.begin(), block.x.begin() + count);
    }
    return placed;
}

// raster_setup.hpp, "Growing", in double precision and from all nodes.
double exactPixels(const Scene& scene, const TestNode& node, const TestPoint& point) {
    const FramePlan& plan = scene.plan;
    int drawn = finestLevel(scene.drawn, node, point), deepest = finestLevel(scene.all, node, point);
    bool perspective = plan.view.projection == Projection::perspective;
    double depth = dot(node.world(point) - octreeView(plan.view.projection).position, plan.view.forward);
    double half = perspective ? plan.view.tanHalfFovY * depth : plan.view.halfHeight;
    double apart =
        std::ldexp(node.spacing, node.key.level - drawn) * plan.style.sizeSpacings * plan.height / (2 * half);
    double most = std::ldexp(plan.style.sizePixels, std::min(deepest - drawn, maxDoublings));
    return std::clamp(apart, plan.style.sizePixels, std::min(most, plan.style.maxSizePixels));
}

} // namespace

TEST_CASE("a point is as wide as points are apart where finer ones are awaited, and no wider than those "
          "levels allow") {
    for (Projection projection : {Projection::perspective, Projection::orthographic}) {
        Scene scene =
            sceneOf(40, projection, fixedStyle(), [](std::size_t i) { return i == 0 || i % 3 == 1; });
        int judged = 0, grown = 0, between = 0; // neither the size itself nor it doubled
        for (std::size_t n = 0; n < scene.drawn.size(); ++n) {
            Placed placed = softwareSizes(scene.plan, n);
            for (std::size_t i = 0; i < placed.size64.size(); ++i) {
                if (placed.x[i] == nowhere)
                    continue;
                double exact = exactPixels(scene, scene.drawn[n], scene.drawn[n].points[i]);
                INFO("node " << n << ", point " << i << ": " << placed.size64[i] / 64.0 << ", exact "
                             << exact);
                CHECK(std::abs(placed.size64[i] - 64 * exact) <= 1.01); // whole steps, rounded down
                ++judged;
                grown += exact > scene.plan.style.sizePixels;
                between += std::ldexp(exact, -std::ilogb(exact)) != 1;
            }
        }
        CHECK(judged > 500);
        CHECK(grown > 200);
        CHECK(between > 50);
    }
}

TEST_CASE("points that grow cover what was a hole, alike in software and GLES", "[gles]") {
    auto software = SoftwareRenderer::create(1);
    auto* context = eglContext();
    auto gles = context ? GlesRenderer::create() : Result<std::unique_ptr<GlesRenderer>>(Error{});
    auto covered = [](const std::vector<float>& distances) {
        return std::count_if(distances.begin(), distances.end(),
                             [](float d) { return d > 0 && std::isfinite(d); });
    };
    for (Projection projection : {Projection::perspective, Projection::orthographic})
        for (bool splats : {false, true})
            for (bool late : {false, true})
                for (double detail : {0.0, 6.0}) {
                    Style style = fixedStyle();
                    style.splats.enabled = splats;
                    style.delayedExpansion = late ? DelayedExpansion::on : DelayedExpansion::off;
                    style.detail.mode = detail > 0 ? DetailMode::continuous : DetailMode::discrete;
                    Scene scene = sceneOf(60, projection, style, [](std::size_t i) { return i < 9; });
                    scene.plan.detailPixels = detail;
                    INFO("splats " << splats << " late " << late << " detail " << detail);
                    Image picture = software->render(scene.plan);
                    auto with = covered(software->distances());
                    CHECK(SoftwareRenderer::create(3)->render(scene.plan).rgba == picture.rgba);
                    FramePlan still = scene.plan;
                    still.awaited.clear();
                    software->render(still);
                    CHECK(with > covered(software->distances()));
                    if (!context)
                        continue;
                    REQUIRE(gles.ok());
                    auto apart = measure::pixelError(picture, glesPicture(*context, **gles, scene.plan), 2);
                    CHECK(apart.differing <= allowedPixels(*context, picture.rgba.size() / 4));
                }
}

TEST_CASE(
    "nothing grows where nothing is awaited, where it is switched off, and where sizes come from elsewhere") {
    auto software = SoftwareRenderer::create(1);
    auto none = [](std::size_t) { return true; };
    auto some = [](std::size_t i) { return i < 9; };
    CHECK_FALSE(rasterFrame(sceneOf(20, Projection::perspective, fixedStyle(), none).plan).growing);
    Style style = fixedStyle();
    style.growsWhileLoading = false;
    CHECK_FALSE(rasterFrame(sceneOf(20, Projection::perspective, style, some).plan).growing);
    style = fixedStyle();
    for (PointSizeMode mode : {PointSizeMode::world, PointSizeMode::adaptive}) {
        style.sizeMode = mode;
        CHECK_FALSE(rasterFrame(sceneOf(20, Projection::perspective, style, some).plan).growing);
    }
    style = fixedStyle(100);
    style.maxSizePixels = 64;
    CHECK_FALSE(rasterFrame(sceneOf(20, Projection::perspective, style, some).plan).growing);
}

TEST_CASE("a node with too few of its points counts as awaited, for its own points too") {
    Scene scene = sceneOf(40, Projection::orthographic, fixedStyle(0.5), [](std::size_t) { return true; });
    std::size_t leaf = scene.drawn.size() - 1;
    scene.plan.awaited.push_back({scene.plan.nodes[leaf].cloud, scene.drawn[leaf].key});
    double apart = scene.drawn[leaf].spacing * scene.plan.style.sizeSpacings * scene.plan.height / (2 * 7.0);
    // Twice the node's spacing, but no more than twice the size; sizes are of at least a pixel.
    int expected = static_cast<int>(64 * std::clamp(2 * apart, 1.0, 2.0));
    for (int size64 : softwareSizes(scene.plan, leaf).size64)
        CHECK(std::abs(size64 - expected) <= 1);
}

TEST_CASE("a point is picked where it has grown to", "[software]") {
    TestNode node;
    node.nodeBits = 2;
    node.points = {{1, 1, 1}};
    node.key = {8, 3, 3, 3};
    node.spacing = 100;
    TestView view;
    view.projection = Projection::orthographic;
    FramePlan plan = testPlan({node}, view, fixedStyle(10));
    plan.awaited = {{plan.nodes[0].cloud, node.key.child(0)}};
    REQUIRE(rasterFrame(plan).growing);
    auto renderer = SoftwareRenderer::create(1);
    renderer->render(plan);
    std::vector<float> distances = renderer->distances();
    std::size_t shown = 0;
    for (int y = 0; y < plan.height; ++y)
        for (int x = 0; x < plan.width; ++x) {
            bool shows = distances[static_cast<std::size_t>(y * plan.width + x)] > 0;
            INFO("pixel " << x << ", " << y);
            CHECK(renderer->pick(plan, {x + 0.5, y + 0.5, 0}).has_value() == shows);
            shown += shows;
        }
    CHECK(shown > 250); // 20 pixels wide; 10 would be 79
}
