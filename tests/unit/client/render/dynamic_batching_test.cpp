// Dynamic batching (tests/bench/point_batches.hpp) gives each point the size that the walk through the drawn
// octree finds, each point is drawn once, and so pictures are the same, but for points at equal depths, whose
// order is another one.
#include "client/measure/pixel_error.hpp"
#include "client/render/software_renderer.hpp"
#include "tests/bench/adaptive_drawer.hpp"
#include "tests/bench/sized_points.hpp"
#include "tests/support/gles.hpp"
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

FramePlan planOf(const std::vector<TestNode>& nodes, Projection projection = Projection::perspective) {
    return testPlan(nodes, octreeView(projection), adaptiveStyle());
}

std::vector<TestNode> without(const std::vector<TestNode>& nodes, std::size_t which) {
    std::vector<TestNode> rest;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (i % 5 != which)
            rest.push_back(nodes[i]);
    return rest;
}

} // namespace

TEST_CASE("batches draw every point once, in the size that the walk through the octree finds") {
    for (int rootBits : {12, 21, 26, 31}) {
        INFO(rootBits << " bits");
        std::vector<TestNode> nodes =
            randomOctree(11, 4, 120, rootBits, {-5, -5, -5}, std::ldexp(10, -rootBits));
        PointBatches batches;
        // A whole tree, one with nodes missing between others, and the whole one again.
        for (std::size_t missing : {5u, 2u, 5u}) {
            FramePlan plan = planOf(without(nodes, missing));
            batches.update(plan);
            CHECK(sizedByBatches(batches) == sizedByWalk(plan));
            CHECK(batches.counters().vertices == batches.counters().ownPoints);
        }
        FramePlan prefixes = planOf(nodes);
        for (std::size_t i = 0; i < prefixes.nodes.size(); ++i)
            prefixes.nodes[i].pointCount = static_cast<std::uint32_t>(i * 37 % 121);
        batches.update(prefixes);
        CHECK(sizedByBatches(batches) == sizedByWalk(prefixes));
    }
}

TEST_CASE("clouds one in another do not take each other's points") {
    std::vector<TestNode> nodes = randomOctree(5, 3, 20, 12, {-5, -5, -5}, 0.002);
    std::size_t first = nodes.size();
    for (const TestNode& node : randomOctree(6, 2, 30, 12, {-5, -5, -5}, 0.002))
        nodes.push_back(node);
    FramePlan plan = planOf(nodes);
    for (std::size_t i = first; i < nodes.size(); ++i)
        plan.nodes[i].cloud = 7;
    PointBatches batches;
    batches.update(plan);
    CHECK(sizedByBatches(batches) == sizedByWalk(plan));
}

TEST_CASE("lists stand until their points or those above them change") {
    FramePlan plan = planOf(randomOctree(5, 3, 20, 12, {-5, -5, -5}, 0.002));
    PointBatches batches;
    batches.update(plan);
    CHECK(batches.counters().listsMade == plan.nodes.size());
    std::uint64_t bytes = batches.counters().bytes;
    batches.update(plan);
    CHECK(batches.counters().listsMade == 0);

    // Of a node without children only its own; of the root all.
    FramePlan fewer = plan;
    fewer.nodes.back().pointCount -= 1;
    batches.update(fewer);
    CHECK(batches.counters().listsMade == 1);
    fewer.nodes.front().pointCount -= 1;
    batches.update(fewer);
    CHECK(batches.counters().listsMade == plan.nodes.size());
    batches.update(plan);
    CHECK(batches.counters().bytes == bytes);

    // What is not drawn any more is kept for a while, then gone.
    FramePlan root = plan;
    root.nodes.resize(1);
    for (int i = 0; i < 100; ++i)
        batches.update(root);
    CHECK(batches.counters().bytes < bytes / 10);
}

TEST_CASE("what is left out as unseen shows nowhere") {
    // Squares of a pixel, so that a point outside the picture leaves nothing in it.
    Style style = adaptiveStyle();
    style.maxSizePixels = 1;
    for (Projection projection : {Projection::perspective, Projection::orthographic}) {
        TestView view = octreeView(projection);
        view.position = {0.2, -4, 0.1};
        view.halfHeight = 1;
        FramePlan plan = testPlan(randomOctree(8, 3, 60, 12, {-5, -5, -5}, 10.0 / 4096), view, style);
        PointBatches all, seen(true);
        all.update(plan);
        seen.update(plan);
        CHECK(seen.counters().vertices < all.counters().vertices / 2);
        auto renderer = SoftwareRenderer::create(1);
        FramePlan allPlan = planOfRuns(all), seenPlan = planOfRuns(seen);
        Image picture = renderer->render(allPlan);
        CHECK(renderer->render(seenPlan).rgba == picture.rgba);
    }
}

TEST_CASE("pictures of batches are those of the octree texture", "[gles]") {
    auto software = SoftwareRenderer::create(1);
    auto* context = eglContext();
    auto gles = context ? GlesRenderer::create() : Result<std::unique_ptr<GlesRenderer>>(Error{});
    std::vector<TestNode> nodes = randomOctree(21, 3, 25, 12, {-5, -5, -5}, 10.0 / 4096);
    for (Projection projection : {Projection::perspective, Projection::orthographic}) {
        FramePlan plan = planOf(nodes, projection);
        PointBatches batches;
        batches.update(plan);
        Image walked = software->render(plan);
        FramePlan runs = planOfRuns(batches);
        // A point's place is summed from another node's corner: now and then a pixel's edge lies between.
        std::size_t few = walked.rgba.size() / 4 / 500;
        CHECK(measure::pixelError(walked, software->render(runs), 0).differing <= few);
        if (!context)
            continue;
        REQUIRE(gles.ok());
        Image wanted = glesPicture(*context, **gles, plan);
        AdaptiveDrawer drawer;
        auto target = context->framebuffer(plan.width, plan.height);
        REQUIRE(target.ok());
        REQUIRE(drawer.drawByOctree(plan, *target).ok());
        auto octree = context->read();
        REQUIRE(octree.ok());
        CHECK(octree->rgba == wanted.rgba);
        REQUIRE(drawer.drawBatches(batches, *target).ok());
        auto batched = context->read();
        REQUIRE(batched.ok());
        CHECK(measure::pixelError(wanted, *batched, 0).differing <= few);
    }
}
