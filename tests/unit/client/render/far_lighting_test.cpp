// Eye-dome lighting where depth is coarsest: at the far end of a range of 2^30, and at its near end in the
// same view.
#include "client/render/software_renderer.hpp"
#include "tests/support/gles.hpp"
#include "tests/support/reference_picture.hpp"
#include "tests/support/test_plan.hpp"

#include <cstdio>

using namespace stipple;
using namespace stipple::test;

namespace {

struct Scene {
    std::vector<TestNode> nodes;
    TestView view;
    Style style;
};

// Points all about `distance` away, in a box as wide as the view there and `depth` deep.
Scene sceneAt(double distance, double depth, double strength) {
    Scene scene;
    double side = distance; // tan of half the view is 0.5
    TestNode node = randomNode(11, 5000, 16, {-side / 2, distance, -side / 2}, side / 65536);
    node.scale.y = depth / 65536;
    scene.nodes = {node};
    scene.view.position = {0, 0, 0};
    scene.view.target = {0, 1, 0};
    scene.view.near = 0.9;
    scene.view.far = 1e9;
    scene.style.sizePixels = 3;
    scene.style.shape = PointShape::square;
    scene.style.edl.strength = strength;
    return scene;
}

} // namespace

TEST_CASE("eye-dome lighting is the reference's at both ends of a range of 2^30", "[numerics][gles]") {
    auto* context = eglContext();
    auto gles = context ? GlesRenderer::create() : Result<std::unique_ptr<GlesRenderer>>(Error{});
    auto software = SoftwareRenderer::create(1);
    for (double distance : {1.0, 1e4, 4e8})
        for (double depth : {0.3, 0.003}) { // of the distance
            INFO("distance " << distance << ", depth " << depth);
            Scene scene = sceneAt(distance, depth * distance, 0.004 * 0.3 / depth);
            FramePlan plan = testPlan(scene.nodes, scene.view, scene.style);
            Image picture = software->render(plan);
            ReferencePicture expected = referencePicture(scene.nodes, scene.view, scene.style);
            CHECK(wrongPixels(picture, expected, 4) == 0);
            CHECK(wrongDistances(software->distances(), expected) == 0);
            std::size_t shaded = 0, sure = 0;
            Style plain = scene.style;
            plain.edl.enabled = false;
            FramePlan unlit = testPlan(scene.nodes, scene.view, plain);
            Image flat = SoftwareRenderer::create(1)->render(unlit);
            for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
                shaded += picture.rgba[i] + 8 < flat.rgba[i];
            for (bool pixel : expected.unsure)
                sure += !pixel;
            CHECK(shaded > picture.rgba.size() / 4 / 20); // there is something to be wrong about
            CHECK(sure > expected.unsure.size() / 2);
            if (!context)
                continue;
            REQUIRE(gles.ok());
            auto apart = measure::pixelError(picture, glesPicture(*context, **gles, plan), 3);
            CHECK(apart.differing <= allowedPixels(*context, picture.rgba.size() / 4));
        }
}
