#include "client/render/software_renderer.hpp"
#include "tests/support/reference_picture.hpp"
#include "tests/support/test_plan.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>

using namespace stipple;
using namespace stipple::test;

namespace {

using Rgb = std::array<int, 3>;

Rgb pixel(const Image& image, int x, int y) {
    std::size_t at = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                          static_cast<std::size_t>(x));
    return {image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]};
}

std::size_t pixelsUnlike(const Image& image, Rgb colour) {
    std::size_t count = 0;
    for (std::size_t at = 0; at < image.rgba.size(); at += 4)
        count +=
            image.rgba[at] != colour[0] || image.rgba[at + 1] != colour[1] || image.rgba[at + 2] != colour[2];
    return count;
}

Style plainStyle(double pixels) {
    Style style;
    style.edl.enabled = false;
    style.sizePixels = pixels;
    style.shape = PointShape::square;
    style.background = {1, 2, 3};
    return style;
}
constexpr Rgb background{1, 2, 3};

// 12 pixels a unit at the target; the camera is at (0, -10, 0).
TestNode onePoint(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    TestNode node;
    node.points = {{x, y, z, 10, 200, 30, 0}};
    return node;
}

} // namespace

TEST_CASE("the picture does not depend on the number of threads or the order of nodes", "[software]") {
    std::vector<TestNode> nodes;
    for (std::uint64_t i = 0; i < 6; ++i)
        nodes.push_back(randomNode(i, 30000, 10, {-5.0 + 0.5 * static_cast<double>(i), -5, -5}, 0.01));
    Style style = plainStyle(3);
    style.edl.enabled = true;
    style.shape = PointShape::circle;
    FramePlan plan = testPlan(nodes, {}, style);
    Image one = SoftwareRenderer::create(1)->render(plan);
    for (int threads : {2, 3, 8, 11}) { // 11: some draw into the same cells
        auto renderer = SoftwareRenderer::create(threads);
        for (int repeat = 0; repeat < 3; ++repeat)
            CHECK(renderer->render(plan).rgba == one.rgba);
    }
    std::reverse(plan.nodes.begin(), plan.nodes.end());
    CHECK(SoftwareRenderer::create(1)->render(plan).rgba == one.rgba);
}

TEST_CASE("nothing of a picture is left in the next", "[software]") {
    std::vector<TestNode> nodes;
    for (std::uint64_t i = 0; i < 3; ++i)
        nodes.push_back(randomNode(i, 30000, 10, {-5.0 + 0.5 * static_cast<double>(i), -5, -5}, 0.01));
    std::vector<FramePlan> plans;
    for (double pixels : {1, 3})
        for (bool splats : {false, true})
            for (DelayedExpansion expansion : {DelayedExpansion::off, DelayedExpansion::on})
                for (int width : {320, 200}) {
                    Style style = plainStyle(pixels);
                    style.splats.enabled = splats;
                    style.delayedExpansion = expansion;
                    TestView view;
                    view.width = width;
                    std::vector<TestNode> some(nodes.begin(),
                                               nodes.begin() + 1 + static_cast<long>(plans.size() % 3));
                    plans.push_back(testPlan(some, view, style));
                }
    auto renderer = SoftwareRenderer::create(3);
    for (std::size_t i = 0; i < plans.size(); ++i) {
        INFO(i);
        FramePlan& plan = plans[(i * 7) % plans.size()];
        if (i % 3 == 1)
            CHECK(renderer->pick(plan, {100, 120, 4}));
        CHECK(renderer->render(plan).rgba == SoftwareRenderer::create(1)->render(plan).rgba);
    }
}

TEST_CASE("a plan without nodes is the background", "[software]") {
    FramePlan plan = testPlan({}, {}, plainStyle(2));
    CHECK(pixelsUnlike(SoftwareRenderer::create(1)->render(plan), background) == 0);
}

TEST_CASE("a plan whose sides can't be drawn gives an empty picture", "[software]") {
    auto renderer = SoftwareRenderer::create(1);
    for (auto [width, height] : {std::pair{0, 5}, std::pair{5, 0}, std::pair{20000, 5}, std::pair{-3, 5}}) {
        FramePlan plan = testPlan({onePoint(0, 0, 0)}, {}, plainStyle(2));
        plan.width = width;
        plan.height = height;
        CHECK(renderer->render(plan).rgba.empty());
    }
}

TEST_CASE("points behind the camera, too near or too far are not drawn", "[software]") {
    auto renderer = SoftwareRenderer::create(1);
    TestView view;
    view.near = 1;
    view.far = 20;
    for (double y : {-30.0, -10.0, -9.5, 10.5}) { // the camera looks along +y from -10
        TestNode node = onePoint(0, 0, 0);
        node.corner = {0, y, 0};
        FramePlan plan = testPlan({node}, view, plainStyle(4));
        INFO("y = " << y);
        CHECK(pixelsUnlike(renderer->render(plan), background) == 0);
    }
    TestNode node = onePoint(0, 0, 0);
    node.corner = {0, 5, 0};
    FramePlan plan = testPlan({node}, view, plainStyle(4));
    CHECK(pixelsUnlike(renderer->render(plan), background) == 16);
}

TEST_CASE("the prefix that the plan asks for is drawn, no more", "[software]") {
    TestNode node = randomNode(4, 5000, 10, {-5, -5, -5}, 0.01);
    FramePlan part = testPlan({node}, {}, plainStyle(1));
    part.nodes[0].pointCount = 700;
    node.points.resize(700);
    FramePlan cut = testPlan({node}, {}, plainStyle(1));
    auto renderer = SoftwareRenderer::create(1);
    Image a = renderer->render(part);
    CHECK(a.rgba == renderer->render(cut).rgba);
}

TEST_CASE("sizes keep to their limits", "[software]") {
    auto renderer = SoftwareRenderer::create(1);
    auto drawn = [&](const Style& style) {
        FramePlan plan = testPlan({onePoint(0, 0, 0)}, {}, style);
        return pixelsUnlike(renderer->render(plan), background);
    };
    Style style = plainStyle(5000);
    style.maxSizePixels = 6;
    CHECK(drawn(style) == 36);
    style.minSizePixels = 3;
    style.sizePixels = 0.2;
    CHECK(drawn(style) == 9);
    style.sizeMode = PointSizeMode::world; // 12 pixels a unit
    style.sizeWorld = 1e9;
    CHECK(drawn(style) == 36);
    style.sizeWorld = 1e-9;
    CHECK(drawn(style) == 9);
    style.sizeWorld = 1.0 / 3;
    CHECK(drawn(style) == 16);
    // Beyond what any GPU draws: clamped to 255, which covers this picture.
    style.maxSizePixels = style.sizeWorld = 1e9;
    CHECK(drawn(style) == 160 * 120);
    // Smaller than a pixel: still one.
    style.minSizePixels = style.sizeWorld = 0;
    CHECK(drawn(style) == 1);
}

TEST_CASE("a point whose centre lies outside the picture still reaches in", "[software]") {
    TestView view;
    view.projection = Projection::orthographic;
    view.halfHeight = 6; // 10 pixels a unit: x is 0.6 pixels left of the picture
    TestNode node = onePoint(0, 0, 0);
    node.corner = {-8.06, 0, 0.05};
    FramePlan plan = testPlan({node}, view, plainStyle(4));
    // It covers -2.6 … 1.4: of the picture the middle of column 0.
    Image image = SoftwareRenderer::create(1)->render(plan);
    CHECK(pixelsUnlike(image, background) == 4);
    CHECK(pixel(image, 0, 59) == Rgb{10, 200, 30});
}

TEST_CASE("the nearest point wins, and of equally near ones the first in draw order", "[software]") {
    TestNode node;
    node.points = {
        {0, 200, 0, 1, 1, 1, 0}, {0, 100, 0, 2, 2, 2, 0}, {0, 100, 0, 3, 3, 3, 0}, {0, 150, 0, 4, 4, 4, 0}};
    FramePlan plan = testPlan({node}, {}, plainStyle(1));
    Image image = SoftwareRenderer::create(1)->render(plan);
    CHECK(pixel(image, 80, 59) == Rgb{2, 2, 2});
}

TEST_CASE("wide nodes keep their low bits", "[software]") {
    TestView view;
    view.position = {5000, -3, 4000}; // 31 bits of 10 µm: 21 km; the picture is 2.5 m wide
    view.target = {5000, 0, 4000};
    auto renderer = SoftwareRenderer::create(1);
    TestNode node = randomNode(5, 3000, 16, {0, 0, 0}, 0.00001);
    node.nodeBits = 31;
    for (TestPoint& p : node.points) { // a cube of 65 cm around (5000, 0, 4000)
        p.x += 500'000'000 - 32768;
        p.z += 400'000'000 - 32768;
    }
    Style style = plainStyle(1);
    FramePlan plan = testPlan({node}, view, style);
    REQUIRE(plan.nodes[0].node->positionShift == 10);
    ReferencePicture reference = referencePicture({node}, view, style);
    CHECK(wrongPixels(renderer->render(plan), reference, 1) == 0);
    CHECK(pixelsUnlike(renderer->render(plan), background) > 300);
}

TEST_CASE("far from the origin points stay where they belong", "[software]") {
    struct Place {
        const char* name;
        Vec3d corner;
        double scale;
    };
    for (const Place& place :
         {Place{"UTM", {637000, 4849000, 130}, 0.01}, Place{"ECEF", {-2500000, -4650000, 3550000}, 0.001},
          Place{"offset 10^9, 1 mm", {1e9, 1e9, 1e9}, 0.001}}) {
        INFO(place.name);
        TestNode node = randomNode(6, 4000, 12, place.corner, place.scale);
        double side = 4096 * place.scale;
        TestView view;
        view.position = place.corner + Vec3d{0.37, -1.9, 0.81} * side;
        view.target = place.corner + Vec3d{0.5, 0.5, 0.5} * side;
        view.near = side * 0.01;
        view.far = side * 10;
        Style style = plainStyle(2);
        FramePlan plan = testPlan({node}, view, style);
        ReferencePicture reference = referencePicture({node}, view, style);
        CHECK(wrongPixels(SoftwareRenderer::create(1)->render(plan), reference, 1) == 0);
    }
}

TEST_CASE("eye-dome lighting is a pass that is not run when it would change nothing", "[software]") {
    auto renderer = SoftwareRenderer::create(1);
    Style style = plainStyle(2);
    FramePlan plan = testPlan({onePoint(0, 0, 0)}, {}, style);
    renderer->render(plan);
    CHECK(plan.counters.passesRun == 2); // points, colours
    CHECK(plan.counters.passesSkipped == 1);
    style.edl.enabled = true;
    plan = testPlan({onePoint(0, 0, 0)}, {}, style);
    renderer->render(plan);
    CHECK(plan.counters.passesRun == 3);
    CHECK(plan.counters.passesSkipped == 0);
    style.edl.strength = 0;
    plan = testPlan({onePoint(0, 0, 0)}, {}, style);
    renderer->render(plan);
    CHECK(plan.counters.passesSkipped == 1);
}

TEST_CASE("eye-dome lighting darkens what lies behind an edge and leaves lone points alone", "[software]") {
    // Two neighbouring pixels, the right one a fifth farther away; and a point by itself.
    TestView view;
    view.projection = Projection::orthographic;
    view.halfHeight = 6;
    TestNode node;
    node.points = {
        {5, 0, 5, 200, 200, 200, 0}, {15, 200, 5, 200, 200, 200, 0}, {205, 0, 205, 200, 200, 200, 0}};
    Style style = plainStyle(1);
    style.edl.enabled = true;
    style.edl.strength = 0.05;
    style.edl.neighbours = 8;
    FramePlan plan = testPlan({node}, view, style);
    Image image = SoftwareRenderer::create(1)->render(plan);
    CHECK(pixel(image, 80, 59) == Rgb{200, 200, 200});
    CHECK(pixel(image, 100, 39) == Rgb{200, 200, 200});
    // log2(12 / 10) / 8 × 300 × 0.05 = 0.4932; 200 exp(-0.4932) = 122.1
    CHECK(pixel(image, 81, 59) == Rgb{122, 122, 122});
    CHECK(pixel(image, 82, 59) == background);
}
