// Delayed expansion: what it keeps and what it loses, and that software and GLES do the same.
//
// Tolerance of software against GLES: as in picture_match_test.cpp and splats_test.cpp: 1 pixel in 2000
// further apart than 2 levels, 3 with eye-dome lighting.
#include "client/render/raster_setup.hpp"
#include "client/render/software_renderer.hpp"
#include "tests/support/gles.hpp"
#include "tests/support/test_plan.hpp"

#include "client/measure/pixel_error.hpp"

#include <algorithm>

using namespace stipple;
using namespace stipple::test;

namespace {

Style lateStyle(double pixels, PointShape shape = PointShape::circle) {
    Style style;
    style.edl.enabled = false;
    style.sizePixels = pixels;
    style.shape = shape;
    style.delayedExpansion = DelayedExpansion::on;
    return style;
}

// World units from the picture's middle to its upper edge.
constexpr double viewHalfHeight = 9;

std::vector<Style> styles() {
    std::vector<Style> all;
    for (PointShape shape : {PointShape::square, PointShape::circle})
        for (double size : {1.0, 2.0, 3.0, 7.3, 40.0}) {
            all.push_back(lateStyle(size, shape));
            Style world = all.back();
            world.sizeMode = PointSizeMode::world;
            world.sizeWorld = 0.1 * size;
            all.push_back(world);
            Style adaptive = all.back();
            adaptive.sizeMode = PointSizeMode::adaptive;
            adaptive.sizeSpacings = 0.2 * size;
            all.push_back(adaptive);
        }
    std::size_t plain = all.size();
    for (std::size_t i = 0; i < plain; ++i) {
        Style splats = all[i];
        splats.splats = {true, 2, 0.02};
        all.push_back(splats);
        Style lit = all[i];
        lit.edl.enabled = true;
        lit.edl.strength = 0.004;
        all.push_back(lit);
    }
    return all;
}

std::vector<TestNode> tree() {
    return randomOctree(21, 3, 60, 12, {-5, -5, -5}, 10.0 / 4096);
}

} // namespace

TEST_CASE("points that share no pixel are expanded to the very picture of drawing them at once",
          "[software]") {
    // A grid 3 pixels apart (12 pixels a unit), each point elsewhere in its pixel; sizes to where they
    // overlap.
    TestNode node;
    node.corner = {-6, -1, -4};
    node.nodeBits = 11;
    TestRandom random(3);
    for (std::uint32_t x = 0; x < 40; ++x)
        for (std::uint32_t z = 0; z < 30; ++z) {
            TestPoint point;
            point.x = 25 * x + random.below(8);
            point.y = (30 * x + z) * 7 % 1200; // no two at one depth: ties go by another order
            point.z = 25 * z + random.below(8);
            point.r = static_cast<std::uint8_t>(random.below(256));
            node.points.push_back(point);
        }
    TestView view;
    view.projection = Projection::orthographic;
    auto renderer = SoftwareRenderer::create(1);
    for (double size : {2.0, 2.7, 4.0, 9.0})
        for (PointShape shape : {PointShape::square, PointShape::circle})
            for (bool splats : {false, true}) {
                Style style = lateStyle(size, shape);
                style.splats.enabled = splats;
                FramePlan plan = testPlan({node}, view, style);
                Image late = renderer->render(plan);
                std::vector<float> distances = renderer->distances();
                plan.style.delayedExpansion = DelayedExpansion::off;
                Image atOnce = renderer->render(plan);
                CHECK(late.rgba == atOnce.rgba);
                CHECK(distances == renderer->distances());
            }
}

TEST_CASE("what lies behind another point's centre is lost, what is nearer never", "[software]") {
    TestNode node;
    node.corner = {0, 0, 0};
    // On one line of sight, the nearer of 9 pixels, the farther of more: it is drawn larger (adaptive sizes).
    node.points = {{100, 100, 100, 255, 0, 0}};
    node.spacing = 0.3;
    node.key = {9, 0, 0, 0};
    TestNode larger = node;
    larger.points = {{100, 500, 100, 0, 255, 0}};
    larger.spacing = 1;
    larger.key = {8, 5, 5, 5};
    TestView view;
    view.projection = Projection::orthographic;
    Style style = lateStyle(9);
    style.sizeMode = PointSizeMode::adaptive;
    style.sizeSpacings = 2;
    FramePlan plan = testPlan({node, larger}, view, style);
    auto count = [&](std::size_t channel) {
        Image image = SoftwareRenderer::create(1)->render(plan);
        int found = 0;
        for (std::size_t at = channel; at < image.rgba.size(); at += 4)
            found += image.rgba[at] == 255;
        return found;
    };
    int red = count(0);
    CHECK(red > 30);
    CHECK(count(1) == 0);
    plan.style.delayedExpansion = DelayedExpansion::off;
    CHECK(count(0) == red);
    CHECK(count(1) > 5 * red);
}

TEST_CASE("threads change nothing of an expanded picture", "[software]") {
    for (const Style& style : styles()) {
        FramePlan plan = testPlan(tree(), octreeView(Projection::perspective, viewHalfHeight), style);
        Image one = SoftwareRenderer::create(1)->render(plan);
        CHECK(SoftwareRenderer::create(3)->render(plan).rgba == one.rgba);
    }
}

TEST_CASE("expanded software and GLES pictures are the same", "[gles]") {
    auto* context = eglContext();
    if (!context)
        return;
    auto gles = GlesRenderer::create();
    REQUIRE(gles.ok());
    auto software = SoftwareRenderer::create(1);
    std::size_t beyond = 0, differs = 0;
    int largest = 0;
    for (Projection projection : {Projection::perspective, Projection::orthographic})
        for (Style style : styles())
            for (double continuous : {0.0, 6.0}) {
                style.detail.mode = continuous > 0 ? DetailMode::continuous : DetailMode::discrete;
                FramePlan plan = testPlan(tree(), octreeView(projection, viewHalfHeight), style);
                plan.detailPixels = continuous;
                Image a = software->render(plan);
                Image b = glesPicture(*context, **gles, plan);
                auto apart = measure::pixelError(a, b, style.edl.enabled ? 3 : 2);
                INFO("size " << style.sizePixels << " mode " << int(style.sizeMode) << " splats "
                             << style.splats.enabled);
                CHECK(apart.differing <= allowedPixels(*context, a.rgba.size() / 4));
                auto distances = (*gles)->distances(plan);
                REQUIRE(distances.ok());
                CHECK(distancesAgree(*context, *distances, software->distances()));
                beyond += apart.differing;
                largest = std::max(largest, static_cast<int>(apart.largest));
                plan.style.delayedExpansion = DelayedExpansion::off;
                differs += software->render(plan).rgba != a.rgba;
            }
    CHECK(differs > 60); // the mode does something
    WARN("largest difference " << largest << " levels, " << beyond << " pixels beyond tolerance");
}

TEST_CASE("automatic delayed expansion goes by the number of points, and is never there for single pixels") {
    Style style = lateStyle(3);
    style.delayedExpansion = DelayedExpansion::automatic;
    FramePlan plan = testPlan({randomNode(1, 1000, 10, {-5, -5, -5}, 0.01)}, {}, style);
    ExpansionCosts costs{1, 0.5};
    double pixels = 160 * 120;
    auto expands = [&] { return expandsLate(plan, rasterFrame(plan), costs); };
    plan.nodes[0].pointCount = static_cast<std::uint32_t>(pixels * 0.9);
    CHECK_FALSE(expands());
    plan.style.splats.enabled = true;
    CHECK(expands());
    plan.style.splats.enabled = false;
    plan.nodes[0].pointCount = static_cast<std::uint32_t>(pixels * 1.1);
    CHECK(expands());
    plan.style.sizePixels = 1;
    CHECK_FALSE(expands());
    plan.style.delayedExpansion = DelayedExpansion::on;
    CHECK_FALSE(expands());
    plan.style.sizePixels = 3;
    CHECK(expands());
    plan.style.delayedExpansion = DelayedExpansion::off;
    CHECK_FALSE(expands());
}
