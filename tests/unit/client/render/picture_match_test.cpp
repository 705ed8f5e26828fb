// The two renderers against each other and against a double-precision reference, over colour modes, sizes,
// shapes, projections and eye-dome lighting.
//
// The stated tolerance: where the reference is sure (no point within 0.01 pixel of the decision, no two
// distances within 4e-6), the software picture has its colours within 1 level (RGB), 4 levels (gradients,
// one table entry), 2 levels more with eye-dome lighting. Software and GLES: at most 1 pixel in 2000 further
// apart than 2 levels (a position that rounds to another 1/128 pixel, a float distance that rounds to another
// step), 3 with eye-dome lighting. On a GPU twenty times as many (tests/support/gles.hpp).
#include "client/render/software_renderer.hpp"
#include "tests/support/gles.hpp"
#include "tests/support/reference_picture.hpp"
#include "tests/support/test_plan.hpp"

#include <cmath>

using namespace stipple;
using namespace stipple::test;

namespace {

struct Scene {
    std::string name;
    std::vector<TestNode> nodes;
    TestView view;
    Style style;
};

// Three nodes of different depth, one behind another, two without some attribute.
std::vector<TestNode> mixedNodes() {
    std::vector<TestNode> nodes{randomNode(1, 4000, 10, {-5, -5, -5}, 0.01),
                                randomNode(2, 2500, 12, {-20, 10, -20}, 0.01),
                                randomNode(3, 500, 9, {1, -8, 0}, 0.01)};
    nodes[1].hasIntensity = false;
    nodes[2].hasColour = false;
    return nodes;
}

std::vector<Scene> scenes() {
    std::vector<Scene> all;
    const std::pair<const char*, ColourMode> colours[] = {
        {"rgb", ColourMode::rgb}, {"intensity", ColourMode::intensity}, {"elevation", ColourMode::elevation}};
    for (Projection projection : {Projection::perspective, Projection::orthographic})
        for (auto [colourName, colour] : colours)
            for (PointShape shape : {PointShape::square, PointShape::circle})
                for (double size : {1.0, 1.4, 2.0, 3.0, 4.0, 7.3, -0.4})
                    for (int neighbours : {0, 4, 8}) {
                        Scene scene;
                        scene.nodes = mixedNodes();
                        scene.view.position = {1.2345, -17.7, 3.21};
                        scene.view.target = {0.3, 0.1, -0.2};
                        scene.view.projection = projection;
                        scene.view.halfHeight = 9;
                        Style& style = scene.style;
                        style.colourMode = colour;
                        style.gradient = GradientName::turbo;
                        style.intensityRange = {200, 3800};
                        style.elevationRange = {-12, 9};
                        style.shape = shape;
                        style.sizeMode = size < 0 ? PointSizeMode::world : PointSizeMode::fixed;
                        style.sizePixels = size;
                        style.sizeWorld = -size;
                        style.edl.enabled = neighbours > 0;
                        style.edl.neighbours = neighbours;
                        style.edl.radiusPixels = neighbours == 4 ? 2.2 : 1.4;
                        // Random depths side by side would all turn black at the default strength.
                        style.edl.strength = 0.004;
                        scene.name = std::string(projection == Projection::perspective ? "perspective "
                                                                                       : "orthographic ") +
                                     colourName + (shape == PointShape::square ? " square " : " circle ") +
                                     std::to_string(size) + " EDL " + std::to_string(neighbours);
                        all.push_back(std::move(scene));
                    }
    return all;
}

int colourTolerance(const Scene& scene) {
    return (scene.style.colourMode == ColourMode::rgb ? 1 : 4) + (scene.style.edl.enabled ? 2 : 0);
}

} // namespace

TEST_CASE("the software picture is the reference's wherever that is sure", "[software]") {
    auto renderer = SoftwareRenderer::create(1);
    std::size_t unsure = 0, total = 0;
    for (const Scene& scene : scenes()) {
        INFO(scene.name);
        ReferencePicture reference = referencePicture(scene.nodes, scene.view, scene.style);
        FramePlan plan = testPlan(scene.nodes, scene.view, scene.style);
        const Image& image = renderer->render(plan);
        CHECK(wrongPixels(image, reference, colourTolerance(scene)) == 0);
        CHECK(wrongDistances(renderer->distances(), reference) == 0);
        for (bool pixel : reference.unsure)
            unsure += pixel;
        total += reference.unsure.size();
    }
    // The comparison means something: nearly every pixel is judged.
    CHECK(static_cast<double>(unsure) < 0.1 * static_cast<double>(total));
    WARN("unsure pixels: " << unsure << " of " << total);
}

TEST_CASE("software and GLES draw the same picture", "[gles]") {
    auto* context = eglContext();
    if (!context)
        return;
    auto gles = GlesRenderer::create();
    REQUIRE(gles.ok());
    auto software = SoftwareRenderer::create(1);
    measure::PixelError worst;
    std::size_t pixels = 0, beyond = 0;
    double sum = 0;
    for (const Scene& scene : scenes()) {
        INFO(scene.name);
        FramePlan plan = testPlan(scene.nodes, scene.view, scene.style);
        Image a = software->render(plan);
        Image b = glesPicture(*context, **gles, plan);
        measure::PixelError apart = measure::pixelError(a, b, scene.style.edl.enabled ? 3 : 2);
        CHECK(apart.differing <= allowedPixels(*context, a.rgba.size() / 4));
        auto distances = (*gles)->distances(plan);
        REQUIRE(distances.ok());
        CHECK(distancesAgree(*context, *distances, software->distances()));
        worst.largest = std::max(worst.largest, apart.largest);
        beyond += apart.differing;
        pixels += a.rgba.size() / 4;
        sum += apart.mean * static_cast<double>(a.rgba.size() / 4);
    }
    WARN("largest difference " << worst.largest << " levels, mean " << sum / static_cast<double>(pixels)
                               << ", " << beyond << " of " << pixels << " pixels beyond tolerance");
}
