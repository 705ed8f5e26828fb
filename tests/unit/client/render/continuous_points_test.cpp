// Continuous detail in the rasterizers: which points are drawn, how large, and that both draw the same.
#include "client/measure/pixel_error.hpp"
#include "client/render/software_renderer.hpp"
#include "tests/support/gles.hpp"
#include "tests/support/test_plan.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace stipple;
using namespace stipple::test;

namespace {

constexpr double spacing = 0.35;

// World units from the picture's middle to its upper edge.
constexpr double viewHalfHeight = 9;

FramePlan continuousPlan(const std::vector<TestNode>& nodes, const TestView& view, const Style& style) {
    FramePlan plan = testPlan(nodes, view, style);
    plan.detailPixels = style.detail.spacingPixels;
    for (DrawNode& node : plan.nodes) {
        node.spacing = spacing;
        node.density = rankDensity(node.node->key.level, spacing, node.node->totalPoints);
    }
    return plan;
}

// (target / spacing)² of a point, in double, from the definition.
double ratioSquared(const FramePlan& plan, const TestNode& node, std::uint32_t rank, Vec3d eye) {
    const ViewTransform& view = plan.view;
    Vec3d r = node.world(node.points[rank]) - eye;
    double depth = dot(r, view.forward);
    double halfHeight =
        view.projection == Projection::perspective ? view.tanHalfFovY * depth : view.halfHeight;
    double x = dot(r, view.right) / (halfHeight * view.aspect), y = dot(r, view.up) / halfHeight;
    const Detail& detail = plan.style.detail;
    double density = std::max(1 - detail.peripheralFalloff * std::hypot(x, y), detail.peripheralDensity);
    double target = plan.detailPixels * 2 * halfHeight / plan.height / density;
    double n = static_cast<double>(node.points.size());
    double pointSpacing = 2 * spacing / std::sqrt(1 + 3 * (rank + 0.5) / n); // level 8: testPlan's
    return target * target / (pointSpacing * pointSpacing);
}

Style styleOf(double spacingPixels, double falloff) {
    Style style;
    style.edl.enabled = false;
    style.shape = PointShape::square;
    style.sizePixels = 3;
    style.detail.mode = DetailMode::continuous;
    style.detail.spacingPixels = spacingPixels;
    style.detail.peripheralFalloff = falloff;
    return style;
}

std::vector<Style> styles() {
    std::vector<Style> all;
    for (double falloff : {0.0, 0.5, 1.0})
        for (double growth : {0.0, 0.2, 0.9})
            for (PointSizeMode mode : {PointSizeMode::fixed, PointSizeMode::world, PointSizeMode::spacing})
                for (double size : {1.0, 5.0})
                    for (PointShape shape : {PointShape::square, PointShape::circle}) {
                        Style style = styleOf(2.5, falloff);
                        style.detail.growthRange = growth;
                        style.sizeMode = mode;
                        style.sizePixels = size;
                        style.sizeWorld = 0.1 * size;
                        style.sizeSpacings = size / 2.5;
                        style.shape = shape;
                        all.push_back(style);
                    }
    return all;
}

} // namespace

TEST_CASE("the points drawn are those whose spacing exceeds the target, by definition", "[software]") {
    auto renderer = SoftwareRenderer::create(1);
    for (Projection projection : {Projection::perspective, Projection::orthographic})
        for (double falloff : {0.0, 0.5, 1.0})
            for (double pixels : {2.5, 3.5}) {
                TestView view = octreeView(projection, viewHalfHeight);
                Style style = styleOf(pixels, falloff);
                style.detail.growthRange = 0; // whole or not at all
                std::vector<TestNode> nodes{randomNode(1, 4000, 10, {-5, -5, -5}, 0.01)};
                FramePlan plan = continuousPlan(nodes, view, style);
                std::vector<TestNode> shown = nodes;
                shown[0].points.clear();
                int near = 0;
                for (std::uint32_t i = 0; i < nodes[0].points.size(); ++i) {
                    double q = ratioSquared(plan, nodes[0], i, view.position);
                    near += std::abs(q - 1) < 2e-6;
                    if (q < 1)
                        shown[0].points.push_back(nodes[0].points[i]);
                }
                REQUIRE(near == 0); // no question of rounding
                CHECK(shown[0].points.size() < nodes[0].points.size());
                CHECK_FALSE(shown[0].points.empty());
                Style whole = style;
                whole.detail.mode = DetailMode::discrete;
                FramePlan expected = testPlan(shown, view, whole);
                Image picture = renderer->render(plan);
                CHECK(picture.rgba == renderer->render(expected).rgba);
            }
}

TEST_CASE("a point grows from a pixel to its whole size while the target falls through the growth range",
          "[software]") {
    TestNode node;
    node.points = {{500, 500, 500}};
    node.corner = {-5, -5, -5};
    TestView view;
    view.projection = Projection::orthographic;
    view.position = {0, -20, 0};
    Style style = styleOf(1, 0);
    style.background = {0, 0, 0};
    style.sizePixels = 40;
    style.detail.growthRange = 0.5;
    auto renderer = SoftwareRenderer::create(1);
    double pointPixels = 2 * spacing / std::sqrt(2.5) * view.height / (2 * view.halfHeight);
    for (double part : {1.001, 0.999, 0.9, 0.7, 0.51, 0.5, 0.2}) {
        style.detail.spacingPixels = part * pointPixels;
        FramePlan plan = continuousPlan({node}, view, style);
        Image image = renderer->render(plan);
        std::size_t covered = 0;
        for (std::size_t at = 0; at < image.rgba.size(); at += 4)
            covered += image.rgba[at] > 0;
        double grown = std::clamp((1 - part * part) / (1 - 0.25), 0.0, 1.0);
        INFO("part " << part);
        if (part > 1)
            CHECK(covered == 0);
        else
            CHECK(std::sqrt(double(covered)) == Approx(std::max(1.0, 40 * grown)).margin(1.0));
    }
}

TEST_CASE("threads change nothing", "[software]") {
    std::vector<TestNode> nodes{randomNode(1, 40'000, 10, {-5, -5, -5}, 0.01)};
    Style style = styleOf(0.8, 0.5);
    FramePlan plan = continuousPlan(nodes, octreeView(Projection::perspective, viewHalfHeight), style);
    Image one = SoftwareRenderer::create(1)->render(plan);
    CHECK(SoftwareRenderer::create(3)->render(plan).rgba == one.rgba);
}

TEST_CASE("software and GLES draw the same picture with continuous detail", "[gles]") {
    auto* context = eglContext();
    if (!context)
        return;
    auto gles = GlesRenderer::create();
    REQUIRE(gles.ok());
    auto software = SoftwareRenderer::create(1);
    std::vector<TestNode> nodes{randomNode(1, 4000, 10, {-5, -5, -5}, 0.01),
                                randomNode(2, 2500, 12, {-20, 10, -20}, 0.01),
                                randomNode(3, 3000, 24, {-20, 0, -20}, 1e-6)};
    std::size_t drawn = 0;
    for (Projection projection : {Projection::perspective, Projection::orthographic})
        for (const Style& style : styles()) {
            FramePlan plan = continuousPlan(nodes, octreeView(projection, viewHalfHeight), style);
            Image a = software->render(plan);
            Image b = glesPicture(*context, **gles, plan);
            measure::PixelError apart = measure::pixelError(a, b, 2);
            // As picture_match_test states, and points whose size falls on another side of 1/64 pixel.
            CHECK(apart.differing <= allowedPixels(*context, a.rgba.size() / 4));
            drawn += std::any_of(a.rgba.begin(), a.rgba.end(),
                                 [](std::uint8_t level) { return level > 100 && level < 255; });
        }
    CHECK(drawn > 50);
}
