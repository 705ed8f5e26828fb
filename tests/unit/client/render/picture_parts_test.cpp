// A picture drawn in parts is, bit for bit, the one drawn in one piece.
#include "client/render/picture_parts.hpp"
#include "client/render/software_renderer.hpp"
#include "tests/support/gles.hpp"
#include "tests/support/test_plan.hpp"

#include <cstring>
#include <functional>

using namespace stipple;
using namespace stipple::test;

namespace {

std::vector<TestNode> tree(bool withNormals) {
    std::vector<TestNode> nodes = randomOctree(21, 3, 60, 12, {-5, -5, -5}, 10.0 / 4096);
    for (std::size_t i = 0; withNormals && i < nodes.size(); ++i)
        addNormals(nodes[i], i);
    return nodes;
}

Style plainStyle(double pixels, PointShape shape) {
    Style style;
    style.edl.enabled = false;
    style.sizePixels = pixels;
    style.shape = shape;
    return style;
}

// Each way to draw, alone and with splats, delayed expansion and eye-dome lighting.
std::vector<Style> styles() {
    std::vector<Style> all;
    for (double size : {1.0, 3.0, 23.6})
        for (PointShape shape :
             {PointShape::square, PointShape::circle, PointShape::paraboloid, PointShape::disc})
            all.push_back(plainStyle(size, shape));
    Style world = plainStyle(2, PointShape::circle);
    world.sizeMode = PointSizeMode::world;
    world.sizeWorld = 0.3;
    Style adaptive = plainStyle(2, PointShape::circle);
    adaptive.sizeMode = PointSizeMode::adaptive;
    adaptive.sizeSpacings = 0.5;
    all.push_back(world);
    all.push_back(adaptive);
    for (std::size_t i = 0, plain = all.size(); i < plain; ++i)
        for (int change = 0; change < 3; ++change) {
            Style style = all[i];
            if (change == 0)
                style.splats = {true, 2, 0.02};
            if (change == 1)
                style.delayedExpansion = DelayedExpansion::on;
            if (change == 2) {
                style.edl.enabled = true;
                style.edl.strength = 0.004;
                style.edl.radiusPixels = 5.3;
            }
            all.push_back(style);
        }
    return all;
}

// Copies `kept` out of a picture of `drawn`, both parts of the whole.
void paste(const Image& part, const PictureWindow& drawn, const PictureWindow& kept, Image& whole) {
    REQUIRE(part.width == drawn.width);
    REQUIRE(part.height == drawn.height);
    for (int row = kept.bottom; row < kept.bottom + kept.height; ++row) {
        auto from = static_cast<std::size_t>(drawn.bottom + drawn.height - 1 - row) *
                        static_cast<std::size_t>(drawn.width) +
                    static_cast<std::size_t>(kept.left - drawn.left);
        auto to = static_cast<std::size_t>(whole.height - 1 - row) * static_cast<std::size_t>(whole.width) +
                  static_cast<std::size_t>(kept.left);
        std::memcpy(whole.rgba.data() + 4 * to, part.rgba.data() + 4 * from,
                    4 * static_cast<std::size_t>(kept.width));
    }
}

using Draw = std::function<Image(FramePlan&)>;

Image inParts(FramePlan plan, int width, int height, const Draw& draw, FrameCounters& counters) {
    Image whole{plan.width, plan.height, {}};
    whole.rgba.resize(4 * static_cast<std::size_t>(plan.width) * static_cast<std::size_t>(plan.height));
    for (const PictureWindow& kept : partsOf(plan, width, height)) {
        plan.part = withMargin(kept, plan);
        paste(draw(plan), plan.part, kept, whole);
    }
    counters = plan.counters;
    return whole;
}

// Some parts end within the picture, some at its edges.
void compareAll(const Draw& draw) {
    std::uint64_t outside = 0;
    std::size_t cut = 0; // where the margin mattered
    for (Projection projection : {Projection::perspective, Projection::orthographic})
        for (const Style& wanted : styles())
            for (double continuous : {0.0, 6.0}) {
                Style style = wanted;
                style.detail.mode = continuous > 0 ? DetailMode::continuous : DetailMode::discrete;
                style.detail.peripheralFalloff = 0.5;
                std::vector<TestNode> nodes = tree(style.shape == PointShape::disc);
                FramePlan plan = testPlan(nodes, octreeView(projection, 4), style);
                plan.detailPixels = continuous;
                Image whole = draw(plan);
                FrameCounters counters;
                INFO("size " << style.sizePixels << " shape " << int(style.shape) << " mode "
                             << int(style.sizeMode) << " splats " << style.splats.enabled << " expansion "
                             << int(style.delayedExpansion) << " lit " << style.edl.enabled << " projection "
                             << int(projection));
                CHECK(inParts(plan, 61, 43, draw, counters).rgba == whole.rgba);
                CHECK(plan.counters.nodesOutsidePart == 0);
                outside += counters.nodesOutsidePart;
                plan.part = {61, 34, 61, 43};
                Image bare = draw(plan);
                Image same = whole;
                paste(bare, plan.part, plan.part, same);
                cut += same.rgba != whole.rgba;
            }
    CHECK(outside > 1000);
    CHECK(cut > 60);
}

} // namespace

TEST_CASE("the software renderer's picture in parts is that in one piece", "[software]") {
    auto renderer = SoftwareRenderer::create(2);
    compareAll([&](FramePlan& plan) { return renderer->render(plan); });
}

TEST_CASE("the OpenGL ES renderer's picture in parts is that in one piece", "[gles]") {
    auto* context = eglContext();
    if (!context)
        return;
    auto renderer = GlesRenderer::create();
    REQUIRE(renderer.ok());
    compareAll([&](FramePlan& plan) {
        PictureWindow part = drawnWindow(plan);
        auto target = context->framebuffer(part.width, part.height);
        REQUIRE(target.ok());
        Status drawn = (*renderer)->draw(plan, *target);
        INFO((drawn.ok() ? "" : drawn.error().sentence()));
        REQUIRE(drawn.ok());
        auto image = context->read();
        REQUIRE(image.ok());
        return *std::move(image);
    });
}

TEST_CASE("deep nodes of an orthographic view are drawn in parts as in one piece", "[software][gles]") {
    // Content that is long along the view: positions by integers.
    TestNode node = randomNode(5, 4000, 24, {-800, -800, -800}, 1600.0 / (1 << 24));
    TestView view;
    view.projection = Projection::orthographic;
    view.position = {0, -3000, 0};
    view.halfHeight = 30;
    view.far = 1e6;
    Style style = plainStyle(5, PointShape::circle);
    auto software = SoftwareRenderer::create(1);
    for (double size : {1.0, 5.0}) {
        style.sizePixels = size;
        FramePlan plan = testPlan({node}, view, style);
        REQUIRE(rasterNode(plan, plan.nodes[0]).deep);
        FrameCounters counters;
        auto draw = [&](FramePlan& drawn) { return software->render(drawn); };
        Image whole = draw(plan);
        CHECK(inParts(plan, 50, 37, draw, counters).rgba == whole.rgba);
    }
}

TEST_CASE("parts cover the picture once, from left to right and from the top") {
    FramePlan plan;
    plan.width = 100;
    plan.height = 70;
    std::vector<PictureWindow> parts = partsOf(plan, 40, 32);
    std::vector<PictureWindow> wanted{{0, 38, 40, 32}, {40, 38, 40, 32}, {80, 38, 20, 32},
                                      {0, 6, 40, 32},  {40, 6, 40, 32},  {80, 6, 20, 32},
                                      {0, 0, 40, 6},   {40, 0, 40, 6},   {80, 0, 20, 6}};
    CHECK(parts == wanted);
}

TEST_CASE("a margin ends at the picture's edges and is never wider than it may be") {
    Style style = plainStyle(1000, PointShape::circle);
    style.maxSizePixels = 1000;
    style.edl.enabled = true;
    style.edl.radiusPixels = 100;
    TestView view;
    view.width = 5000;
    view.height = 4000;
    FramePlan plan = testPlan({randomNode(1, 10, 8, {0, 0, 0}, 0.01)}, view, style);
    PictureWindow inside = withMargin({1000, 1000, 500, 400}, plan);
    CHECK(inside.left == 1000 - maxPartMargin);
    CHECK(inside.width == 500 + 2 * maxPartMargin);
    CHECK(inside.height == 400 + 2 * maxPartMargin);
    CHECK(withMargin({0, 0, 5000, 4000}, plan) == PictureWindow{0, 0, 5000, 4000});
}

TEST_CASE("a picture larger than what is drawn at once is drawn in parts, and not in one piece",
          "[software]") {
    TestView view;
    view.width = maxPartSide + 100;
    view.height = 90;
    Style style = plainStyle(9, PointShape::circle);
    view.projection = Projection::orthographic;
    TestNode node = randomNode(3, 3000, 12, {-950, -5, -5}, 1);
    node.scale = {1900.0 / 4096, 10.0 / 4096, 10.0 / 4096};
    FramePlan plan = testPlan({node}, view, style);
    auto renderer = SoftwareRenderer::create(1);
    CHECK(renderer->render(plan).rgba.empty());
    plan.part = {maxPartSide - 100, 0, 201, 90};
    CHECK(renderer->render(plan).rgba.empty()); // beyond the picture's edge
    // Cut in two ways: both show the same, also at the far end.
    auto draw = [&](FramePlan& drawn) { return renderer->render(drawn); };
    FrameCounters counters;
    Image one = inParts(plan, 8000, 90, draw, counters), other = inParts(plan, 777, 41, draw, counters);
    CHECK(one.rgba == other.rgba);
    std::size_t lit = 0;
    for (std::size_t x = maxPartSide; x < maxPartSide + 100; ++x)
        for (std::size_t y = 0; y < 90; ++y)
            lit += one.rgba[4 * (y * static_cast<std::size_t>(view.width) + x)] != style.background[0];
    CHECK(lit > 100);
}
