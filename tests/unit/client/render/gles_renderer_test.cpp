#include "client/render/gles_nodes.hpp"
#include "client/render/gles_renderer.hpp"
#include "client/render/software_renderer.hpp"
#include "tests/support/gles.hpp"
#include "tests/support/reference_picture.hpp"
#include "tests/support/test_plan.hpp"

#include <array>

using namespace stipple;
using namespace stipple::test;

namespace {

std::array<int, 3> pixel(const Image& image, int x, int y) {
    std::size_t at = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                          static_cast<std::size_t>(x));
    return {image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]};
}

// Context, renderer, and a check that GL itself had nothing to complain about.
struct Gles {
    headless::EglContext* context = eglContext();
    std::unique_ptr<GlesRenderer> renderer;

    Gles() {
        if (!context)
            return;
        auto made = GlesRenderer::create();
        REQUIRE(made.ok());
        renderer = *std::move(made);
    }
    explicit operator bool() const { return context != nullptr; }
    Image draw(FramePlan& plan) {
        Image image = glesPicture(*context, *renderer, plan);
        CHECK(gles::checkGl("testing").ok());
        return image;
    }
};

Style plainStyle(double pixels) {
    Style style;
    style.edl.enabled = false;
    style.sizePixels = pixels;
    return style;
}

void checkAlike(Gles& gles, FramePlan& plan, const char* what) {
    INFO(what);
    Image software = SoftwareRenderer::create(1)->render(plan);
    measure::PixelError apart = measure::pixelError(software, gles.draw(plan), 2);
    CHECK(apart.differing <= allowedPixels(*gles.context, software.rgba.size() / 4));
}

} // namespace

TEST_CASE("a point appears where the camera projects it, in its colour", "[gles]") {
    Gles gles;
    if (!gles)
        return;
    TestNode node;
    node.points = {{100, 0, 200, 10, 200, 30, 0}}; // world (1, 0, 2)
    TestView view;                                 // from (0, -10, 0), half height 5 at distance 10
    FramePlan plan = testPlan({node}, view, plainStyle(1));
    Image image = gles.draw(plan);
    // 12 pixels a unit: x = 80 + 12, y = 60 - 24.
    CHECK(pixel(image, 92, 35) == std::array<int, 3>{10, 200, 30});
    CHECK(pixel(image, 91, 35) == std::array<int, 3>{24, 26, 30});
    CHECK(pixel(image, 92, 36) == std::array<int, 3>{24, 26, 30});
}

TEST_CASE("without eye-dome lighting GLES draws straight to its target, in one pass", "[gles]") {
    Gles gles;
    if (!gles)
        return;
    Style style = plainStyle(2);
    FramePlan plan = testPlan({randomNode(1, 100, 10, {-5, -5, -5}, 0.01)}, {}, style);
    gles.draw(plan);
    CHECK(plan.counters.passesRun == 1);
    CHECK(plan.counters.passesSkipped == 1);
    style.edl.enabled = true;
    plan.style = style;
    plan.counters = {};
    gles.draw(plan);
    CHECK(plan.counters.passesRun == 2);
    CHECK(plan.counters.passesSkipped == 0);
}

TEST_CASE("a picture without points is GLES's background, and no pass runs for it", "[gles]") {
    Gles gles;
    if (!gles)
        return;
    Style style = plainStyle(2);
    style.edl.enabled = true;
    style.background = {200, 13, 77};
    FramePlan plan = testPlan({}, {}, style);
    Image image = gles.draw(plan);
    for (int y = 0; y < plan.height; ++y)
        for (int x = 0; x < plan.width; ++x)
            REQUIRE(pixel(image, x, y) == std::array<int, 3>{200, 13, 77});
    CHECK(plan.counters.passesRun == 0);
    CHECK(plan.counters.passesSkipped == 2);
}

TEST_CASE("hard cases look the same in GLES and in software", "[gles]") {
    Gles gles;
    if (!gles)
        return;
    FramePlan empty = testPlan({}, {}, plainStyle(2));
    checkAlike(gles, empty, "no nodes");

    TestView inside;
    inside.position = {0.1, 0.2, 0.3};
    inside.target = {0.5, 1, 0.1};
    inside.near = 0.01;
    FramePlan around = testPlan({randomNode(2, 20000, 10, {-5, -5, -5}, 0.01)}, inside, plainStyle(3));
    checkAlike(gles, around, "points all around the camera");

    Style huge = plainStyle(1000);
    huge.maxSizePixels = 1000;
    FramePlan large = testPlan({randomNode(3, 50, 10, {-5, -5, -5}, 0.01)}, {}, huge);
    checkAlike(gles, large, "sizes beyond what may be drawn");

    TestView far;
    far.position = {5000, -3, 4000};
    far.target = {5000, 0, 4000};
    TestNode wide = randomNode(5, 3000, 16, {0, 0, 0}, 0.00001);
    wide.nodeBits = 31;
    for (TestPoint& p : wide.points) {
        p.x += 500'000'000 - 32768;
        p.z += 400'000'000 - 32768;
    }
    FramePlan precise = testPlan({wide}, far, plainStyle(2));
    checkAlike(gles, precise, "a wide node with low words");

    // Many points at equal depth: the first in draw order wins on both sides.
    TestView top;
    top.projection = Projection::orthographic;
    top.position = {0, 0, 20};
    top.target = {0, 0, 0};
    top.up = {0, 1, 0};
    TestNode flat = randomNode(6, 30000, 10, {-5, -5, -5}, 0.01);
    for (TestPoint& p : flat.points)
        p.z = 500 + p.z % 3;
    TestNode second = flat;
    for (TestPoint& p : second.points)
        p.r = static_cast<std::uint8_t>(255 - p.r);
    FramePlan ties = testPlan({flat, second}, top, plainStyle(3));
    checkAlike(gles, ties, "equal depths");
    std::swap(ties.nodes[0], ties.nodes[1]);
    checkAlike(gles, ties, "equal depths, nodes in another order");
}

TEST_CASE("a renderer draws frames of changing size and style one after another", "[gles]") {
    Gles gles;
    if (!gles)
        return;
    std::vector<TestNode> nodes{randomNode(7, 5000, 10, {-5, -5, -5}, 0.01)};
    for (int side : {50, 200, 80})
        for (ColourMode mode : {ColourMode::rgb, ColourMode::intensity, ColourMode::elevation})
            for (bool edl : {false, true}) {
                TestView view;
                view.width = side;
                view.height = side / 2;
                Style style = plainStyle(2);
                style.colourMode = mode;
                style.gradient = edl ? GradientName::turbo : GradientName::grey;
                style.intensityRange = {0, 4095};
                style.elevationRange = {-5, 5};
                style.edl.enabled = edl;
                style.edl.strength = 0.004;
                FramePlan plan = testPlan(nodes, view, style);
                checkAlike(gles, plan, "in turn");
            }
}

TEST_CASE("a node is uploaded once, with the colours in use, and freed with the scene", "[gles]") {
    Gles gles;
    if (!gles)
        return;
    std::uint64_t bare = gles.renderer->gpuBytes();
    Style style = plainStyle(1);
    std::vector<TestNode> nodes{randomNode(8, 1000, 10, {-5, -5, -5}, 0.01)};
    FramePlan plan = testPlan(nodes, {}, style);
    gles.draw(plan);
    CHECK(gles.renderer->gpuBytes() - bare == 1000 * 12);
    gles.draw(plan);
    CHECK(gles.renderer->gpuBytes() - bare == 1000 * 12);
    plan.style.colourMode = ColourMode::intensity;
    plan.style.intensityRange = {0, 4095};
    paintPlan(plan, nodes);
    gles.draw(plan);
    CHECK(gles.renderer->gpuBytes() - bare == 1000 * 12); // in place of the node's own colours
    FramePlan empty = testPlan({}, {}, style);
    gles.draw(empty);
    CHECK(gles.renderer->gpuBytes() == bare);
}

TEST_CASE("nodes that left the view are kept up to a limit, least recently drawn first to go", "[gles]") {
    Gles gles;
    if (!gles)
        return;
    std::uint64_t bare = gles.renderer->gpuBytes();
    TestNode big = randomNode(9, 100, 10, {-5, -5, -5}, 0.01);
    big.points.resize(2'000'000); // 24 MB each: two that are not drawn fit beside the one that is
    big.hasIntensity = false;
    std::vector<FramePlan> plans;
    for (int i = 0; i < 4; ++i)
        plans.push_back(testPlan({big}, {}, plainStyle(1)));
    for (FramePlan& plan : plans) {
        plan.nodes[0].pointCount = 10;
        plan.gpuBytes = 80'000'000;
    }
    for (FramePlan& plan : plans)
        gles.draw(plan);
    CHECK(gles.renderer->gpuBytes() - bare == 3 * 24'000'000);
    // What is drawn stays, whatever the limit; a frame without nodes frees everything.
    plans[3].gpuBytes = 0;
    gles.draw(plans[3]);
    CHECK(gles.renderer->gpuBytes() - bare == 24'000'000);
    plans[3].nodes.clear();
    gles.draw(plans[3]);
    CHECK(gles.renderer->gpuBytes() == bare);
}

TEST_CASE("a picture that can't be drawn is refused in words", "[gles]") {
    Gles gles;
    if (!gles)
        return;
    FramePlan plan = testPlan({}, {}, plainStyle(1));
    plan.width = 0;
    Status status = gles.renderer->draw(plan, 0);
    REQUIRE_FALSE(status.ok());
    CHECK(status.error().code == ErrorCode::invalidArgument);
    CHECK(gles::checkGl("testing").ok());
}

TEST_CASE("a shader that does not compile is reported with the driver's log", "[gles]") {
    Gles gles;
    if (!gles)
        return;
    auto program = gles::makeProgram("", "void main() { gl_Position = nonsense; }", "void main() {}");
    REQUIRE_FALSE(program.ok());
    CHECK(program.error().code == ErrorCode::unsupported);
    CHECK(program.error().what.find("nonsense") != std::string::npos);
}
