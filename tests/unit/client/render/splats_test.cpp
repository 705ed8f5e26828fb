// High-quality splats: what is blended with what, and that software, GLES and the reference give the same
// picture.
//
// Tolerances. Software against the reference, where that is sure: 4 levels (positions in 1/128 pixel move
// weights by up to 1 %), 6 with eye-dome lighting. Software against GLES: 1 pixel in 2000 further apart than
// 2 levels (3 with eye-dome lighting) where GLES sums in 32 bits; where it has 16, whose sums are off by
// 2^-11, 3 and 5.
#include "client/render/software_renderer.hpp"
#include "tests/support/gles.hpp"
#include "tests/support/reference_picture.hpp"
#include "tests/support/test_plan.hpp"

#include <array>

using namespace stipple;
using namespace stipple::test;

namespace {

struct Scene {
    std::string name;
    TestView view;
    Style style;
};

std::vector<Scene> scenes() {
    std::vector<Scene> all;
    for (Projection projection : {Projection::perspective, Projection::orthographic})
        for (PointShape shape : {PointShape::square, PointShape::circle})
            for (double size : {1.0, 2.0, 3.0, 7.3, -0.4})
                for (int hardness : {1, 2, 16})
                    for (double factor : {0.0, 0.01, 0.3}) {
                        Scene scene;
                        scene.view.position = {1.2345, -17.7, 3.21};
                        scene.view.target = {0.3, 0.1, -0.2};
                        scene.view.projection = projection;
                        scene.view.halfHeight = 9;
                        Style& style = scene.style;
                        style.shape = shape;
                        style.sizeMode = size < 0 ? PointSizeMode::world : PointSizeMode::fixed;
                        style.sizePixels = size;
                        style.sizeWorld = -size;
                        style.splats = {true, hardness, factor};
                        style.edl.enabled = factor == 0.01;
                        style.edl.strength = 0.004;
                        scene.name = std::string(projection == Projection::perspective ? "perspective "
                                                                                       : "orthographic ") +
                                     (shape == PointShape::square ? "square " : "circle ") +
                                     std::to_string(size) + " hardness " + std::to_string(hardness) +
                                     " factor " + std::to_string(factor);
                        all.push_back(std::move(scene));
                    }
    return all;
}

std::vector<TestNode> nodesOf() {
    return {randomNode(1, 4000, 10, {-5, -5, -5}, 0.01), randomNode(2, 2500, 12, {-20, 10, -20}, 0.01)};
}

std::array<int, 3> pixel(const Image& image, int x, int y) {
    std::size_t at = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                          static_cast<std::size_t>(x));
    return {image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]};
}

// Largest tolerance-exceeding share over all scenes.
void checkAgainstGles(gles::FloatBlending most, int tolerance, int tolerancePlusEdl) {
    auto* context = eglContext();
    if (!context)
        return;
    auto gles = GlesRenderer::create(most);
    REQUIRE(gles.ok());
    auto software = SoftwareRenderer::create(1);
    measure::PixelError worst;
    std::size_t beyond = 0, pixels = 0;
    for (const Scene& scene : scenes()) {
        INFO(scene.name);
        FramePlan plan = testPlan(nodesOf(), scene.view, scene.style);
        Image a = software->render(plan);
        Image b = glesPicture(*context, **gles, plan);
        CHECK((*gles)->limitation().empty());
        auto apart = measure::pixelError(a, b, scene.style.edl.enabled ? tolerancePlusEdl : tolerance);
        CHECK(apart.differing <= allowedPixels(*context, a.rgba.size() / 4));
        auto distances = (*gles)->distances(plan);
        REQUIRE(distances.ok());
        CHECK(distancesAgree(*context, *distances, software->distances()));
        worst.largest = std::max(worst.largest, apart.largest);
        beyond += apart.differing;
        pixels += a.rgba.size() / 4;
    }
    WARN("largest difference " << worst.largest << " levels, " << beyond << " of " << pixels
                               << " pixels beyond tolerance");
}

} // namespace

TEST_CASE("points within the blend depth are blended by their weights, others are hidden", "[software]") {
    // Grey levels 40 and 200 at one place of the picture, apart in depth; orthographic, a pixel is 1/12 unit.
    TestNode node;
    node.corner = {0, 0, 0};
    node.points = {{100, 100, 100, 40, 40, 40}, {100, 140, 100, 200, 200, 200}};
    TestView view;
    view.projection = Projection::orthographic;
    Style style;
    style.edl.enabled = false;
    style.sizePixels = 4; // radius 1/6 unit; the points are 0.4 apart, 11 and 11.4 from the eye
    style.splats = {true, 1, 0};
    auto renderer = SoftwareRenderer::create(1);
    auto level = [&](double factor) {
        style.splats.depthFactor = factor;
        FramePlan plan = testPlan({node}, view, style);
        return pixel(renderer->render(plan), 92, 47)[0];
    };
    CHECK(level(0) == 40);
    CHECK(level((0.4 - 1 / 6.0) / 11.4 - 1e-4) == 40);
    CHECK(level((0.4 - 1 / 6.0) / 11.4 + 1e-4) == 120); // equal weights: the mean
    // 1 - r²/R² of a point a pixel to the side of one at the pixel's middle, R = 2: 3/4.
    node.points = {{104, 100, 104, 0, 0, 0}, {112, 100, 104, 200, 200, 200}};
    style.splats.depthFactor = 0.1;
    FramePlan plan = testPlan({node}, view, style);
    // Half-unit positions: 92.48 and 93.44 along x, 47.52 along y.
    double w0 = 1 - (0.02 * 0.02 + 0.02 * 0.02) / 4, w1 = 1 - (0.94 * 0.94 + 0.02 * 0.02) / 4;
    CHECK(pixel(renderer->render(plan), 92, 47)[0] == Approx(200 * w1 / (w0 + w1)).margin(1.1));
}

TEST_CASE("the blended software picture is the reference's wherever that is sure", "[software]") {
    auto renderer = SoftwareRenderer::create(1);
    std::size_t unsure = 0, total = 0;
    for (const Scene& scene : scenes()) {
        INFO(scene.name);
        ReferencePicture reference = referencePicture(nodesOf(), scene.view, scene.style);
        FramePlan plan = testPlan(nodesOf(), scene.view, scene.style);
        const Image& image = renderer->render(plan);
        CHECK(wrongPixels(image, reference, scene.style.edl.enabled ? 6 : 4) == 0);
        for (bool pixel : reference.unsure)
            unsure += pixel;
        total += reference.unsure.size();
    }
    CHECK(static_cast<double>(unsure) < 0.2 * static_cast<double>(total));
    WARN("unsure pixels: " << unsure << " of " << total);
}

TEST_CASE("blended software and GLES pictures are the same", "[gles]") {
    checkAgainstGles(gles::FloatBlending::full, 2, 3);
    checkAgainstGles(gles::FloatBlending::half, 3, 5);
}

TEST_CASE("threads and the order of nodes change no blended pixel", "[software]") {
    std::vector<TestNode> nodes;
    for (std::uint64_t i = 0; i < 6; ++i)
        nodes.push_back(randomNode(i, 20'000, 10, {-5, -5, -5}, 0.01));
    Style style;
    style.sizePixels = 5;
    style.splats = {true, 2, 0.1};
    FramePlan plan = testPlan(nodes, {}, style);
    Image one = SoftwareRenderer::create(1)->render(plan);
    CHECK(SoftwareRenderer::create(3)->render(plan).rgba == one.rgba);
    CHECK(SoftwareRenderer::create(11)->render(plan).rgba == one.rgba);
    std::reverse(plan.nodes.begin(), plan.nodes.end());
    CHECK(SoftwareRenderer::create(2)->render(plan).rgba == one.rgba);
}

TEST_CASE("a context without floating-point colours draws plain points and says so", "[gles]") {
    auto* context = eglContext();
    if (!context)
        return;
    auto gles = GlesRenderer::create(gles::FloatBlending::none);
    REQUIRE(gles.ok());
    Scene scene = scenes().front();
    FramePlan plan = testPlan(nodesOf(), scene.view, scene.style);
    Image splats = glesPicture(*context, **gles, plan);
    CHECK((*gles)->limitation().find("EXT_color_buffer_float") != std::string_view::npos);
    plan.style.splats.enabled = false;
    CHECK(glesPicture(*context, **gles, plan).rgba == splats.rgba);
    CHECK((*gles)->limitation().empty());
}

TEST_CASE("a context that draws no point as large as the style asks for says so", "[gles]") {
    auto* context = eglContext();
    if (!context)
        return;
    auto gles = GlesRenderer::create(gles::FloatBlending::full, 5);
    REQUIRE(gles.ok());
    Style style;
    style.sizePixels = 5;
    FramePlan plan = testPlan(nodesOf(), {}, style);
    glesPicture(*context, **gles, plan);
    CHECK((*gles)->limitation().empty());
    plan.style.sizePixels = 5.1;
    glesPicture(*context, **gles, plan);
    CHECK((*gles)->limitation().find("at most 5 pixels") != std::string_view::npos);
    // Sizes that are not known before points are placed: the largest that the style allows.
    plan.style.sizePixels = 1;
    plan.style.sizeMode = PointSizeMode::world;
    glesPicture(*context, **gles, plan);
    CHECK((*gles)->limitation().find("at most 5 pixels") != std::string_view::npos);
    plan.style.maxSizePixels = 5;
    glesPicture(*context, **gles, plan);
    CHECK((*gles)->limitation().empty());
}

TEST_CASE("a picture larger than the driver draws is refused with its limit", "[gles]") {
    auto* context = eglContext();
    if (!context)
        return;
    auto gles = GlesRenderer::create();
    REQUIRE(gles.ok());
    FramePlan plan = testPlan(nodesOf(), {}, {});
    plan.width = maxPartSide + 1;
    Status drawn = (*gles)->draw(plan);
    REQUIRE_FALSE(drawn.ok());
    CHECK(drawn.error().code == ErrorCode::invalidArgument);
    CHECK(drawn.error().sentence().find("each side must be in 1..") != std::string::npos);
}
