// Adaptive sizes: the level that a point's size comes from, in both rasterizers, against looking at all
// nodes; and the pictures.
//
// Tolerance of pictures: as in picture_match_test.cpp; a size may come out a 1/64 pixel apart from the
// reference's exact one, which Slack::pixels covers.
#include "client/render/drawn_octree.hpp"
#include "client/render/software_renderer.hpp"
#include "client/render/software_transform.hpp"
#include "tests/support/gles.hpp"
#include "tests/support/gles_levels.hpp"
#include "tests/support/reference_picture.hpp"
#include "tests/support/test_plan.hpp"

#include <cmath>

using namespace stipple;
using namespace stipple::test;

namespace {

Style adaptiveStyle() {
    Style style;
    style.sizeMode = PointSizeMode::adaptive;
    style.sizeSpacings = 0.4;
    style.edl.enabled = false;
    return style;
}

// As drawn by the software renderer: 512 points at a time.
std::vector<int> softwareLevels(const DrawnOctree& octree, std::size_t place, const DrawNode& node) {
    std::vector<int> levels;
    Block block;
    for (std::size_t first = 0; first < node.pointCount; first += blockPoints) {
        std::size_t count = std::min<std::size_t>(blockPoints, node.pointCount - first);
        fillFineness(octree.words.data(), octree.places[place], *node.node, wordsFrom(*node.node, first),
                     count, block);
        for (std::size_t i = 0; i < count; ++i)
            levels.push_back(-std::ilogb(block.fineness[i]));
    }
    return levels;
}

// Levels below each point's own node, from all nodes of the tree.
std::vector<std::vector<int>> exactLevels(const std::vector<TestNode>& nodes) {
    std::vector<std::vector<int>> levels;
    for (const TestNode& node : nodes) {
        levels.emplace_back();
        for (const TestPoint& point : node.points)
            levels.back().push_back(finestLevel(nodes, node, point) - node.key.level);
    }
    return levels;
}

void checkLevels(const std::vector<TestNode>& nodes, const FramePlan& plan, const char* what) {
    INFO(what);
    std::vector<std::vector<int>> exact = exactLevels(nodes);
    DrawnOctree octree = drawnOctree(plan);
    int deepest = 0;
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
        CHECK(softwareLevels(octree, i, plan.nodes[i]) == exact[i]);
        for (int level : exact[i])
            deepest = std::max(deepest, level);
    }
    CHECK(deepest >= 3);
    if (!eglContext())
        return;
    auto target = eglContext()->framebuffer(16, 16);
    REQUIRE(target.ok());
    auto gles = glesLevels(plan, *target);
    INFO((gles.ok() ? "" : gles.error().sentence()));
    REQUIRE(gles.ok());
    CHECK(*gles == exact);
}

} // namespace

TEST_CASE("the level of every point is that of the finest drawn node that holds it", "[gles]") {
    for (int rootBits : {12, 21, 26, 31}) {
        std::vector<TestNode> nodes =
            randomOctree(11, 4, 120, rootBits, {-5, -5, -5}, std::ldexp(10, -rootBits));
        FramePlan plan = testPlan(nodes, octreeView(Projection::perspective), adaptiveStyle());
        checkLevels(nodes, plan, "a whole tree");

        // Nodes that are not drawn do not count, but what lies below them does.
        std::vector<TestNode> some;
        for (std::size_t i = 0; i < nodes.size(); ++i)
            if (i % 5 != 2)
                some.push_back(nodes[i]);
        plan = testPlan(some, octreeView(Projection::perspective), adaptiveStyle());
        checkLevels(some, plan, "a tree with nodes missing");
    }
}

TEST_CASE("clouds under one another do not see each other's levels") {
    std::vector<TestNode> deep = randomOctree(5, 3, 10, 12, {-5, -5, -5}, 0.002);
    std::vector<TestNode> flat = randomOctree(6, 0, 100, 12, {-5, -5, -5}, 0.002);
    std::vector<TestNode> all = deep;
    all.insert(all.end(), flat.begin(), flat.end());
    FramePlan plan = testPlan(all, {}, adaptiveStyle());
    plan.nodes.back().cloud = 7;
    DrawnOctree octree = drawnOctree(plan);
    for (int level : softwareLevels(octree, plan.nodes.size() - 1, plan.nodes.back()))
        CHECK(level == 0);
    CHECK(octree.words.size() == all.size());
}

TEST_CASE("adaptive pictures are the reference's, and the same in software and GLES", "[gles]") {
    auto software = SoftwareRenderer::create(1);
    auto* context = eglContext();
    auto gles = context ? GlesRenderer::create() : Result<std::unique_ptr<GlesRenderer>>(Error{});
    std::size_t apartPixels = 0, unsure = 0, pixels = 0;
    std::vector<TestNode> nodes = randomOctree(21, 3, 25, 12, {-5, -5, -5}, 10.0 / 4096);
    for (Projection projection : {Projection::perspective, Projection::orthographic})
        for (PointShape shape : {PointShape::square, PointShape::circle})
            for (double spacings : {0.05, 0.4, 1.5}) {
                Style style = adaptiveStyle();
                style.shape = shape;
                style.sizeSpacings = spacings;
                style.edl.enabled = spacings == 0.4;
                style.edl.strength = 0.004;
                TestView view = octreeView(projection);
                INFO("spacings " << spacings << (shape == PointShape::square ? " square" : " circle"));
                FramePlan plan = testPlan(nodes, view, style);
                Image picture = software->render(plan);
                reference::Slack slack;
                slack.pixels = 0.02;
                ReferencePicture expected = referencePicture(nodes, view, style, 1, slack);
                CHECK(wrongPixels(picture, expected, style.edl.enabled ? 3 : 1) == 0);
                CHECK(wrongDistances(software->distances(), expected) == 0);
                for (bool pixel : expected.unsure)
                    unsure += pixel;
                pixels += expected.unsure.size();
                CHECK(SoftwareRenderer::create(3)->render(plan).rgba == picture.rgba);
                if (!context)
                    continue;
                REQUIRE(gles.ok());
                measure::PixelError apart = measure::pixelError(picture, glesPicture(*context, **gles, plan),
                                                                style.edl.enabled ? 3 : 2);
                CHECK(apart.differing <= allowedPixels(*context, picture.rgba.size() / 4));
                apartPixels += apart.differing;
            }
    CHECK(static_cast<double>(unsure) < 0.25 * static_cast<double>(pixels));
    WARN(unsure << " pixels unsure, software and GLES differ in " << apartPixels << " of " << pixels);
}

TEST_CASE("adaptive sizes work with continuous detail alike in software and GLES", "[gles]") {
    auto* context = eglContext();
    if (!context)
        return;
    auto gles = GlesRenderer::create();
    REQUIRE(gles.ok());
    std::vector<TestNode> nodes = randomOctree(21, 3, 60, 12, {-5, -5, -5}, 10.0 / 4096);
    Style style = adaptiveStyle();
    style.detail.mode = DetailMode::continuous;
    FramePlan plan = testPlan(nodes, octreeView(Projection::perspective), style);
    plan.detailPixels = 8;
    Image picture = SoftwareRenderer::create(1)->render(plan);
    measure::PixelError apart = measure::pixelError(picture, glesPicture(*context, **gles, plan), 2);
    CHECK(apart.differing <= allowedPixels(*context, picture.rgba.size() / 4));
    plan.detailPixels = 0;
    CHECK(SoftwareRenderer::create(1)->render(plan).rgba != picture.rgba);
}
