// Paraboloids: software, GLES and the reference.
//
// Tolerance: as in picture_match_test.cpp. The reference is unsure where two paraboloids are as far as a
// shift of 0.01 pixel makes of them.
#include "client/render/software_renderer.hpp"
#include "tests/support/gles.hpp"
#include "tests/support/reference_picture.hpp"
#include "tests/support/test_plan.hpp"

using namespace stipple;
using namespace stipple::test;

TEST_CASE("paraboloids of points side by side meet half way between them", "[software]") {
    TestNode node;
    node.corner = {0, 0, 0};
    node.points = {{100, 100, 100, 255, 0, 0}, {200, 101, 100, 0, 255, 0}}; // 12 pixels apart
    TestView view;
    view.projection = Projection::orthographic;
    Style style;
    style.edl.enabled = false;
    style.sizePixels = 21;
    auto renderer = SoftwareRenderer::create(1);
    auto reds = [&](PointShape shape) {
        style.shape = shape;
        FramePlan plan = testPlan({node}, view, style);
        Image image = renderer->render(plan);
        int count = 0;
        for (int x = 0; x < image.width; ++x)
            count +=
                image.rgba[4 * (47 * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x))] ==
                255;
        return count;
    };
    // The row of pixels next to the points' line: 10 centres to each side lie within 10.5 pixels.
    CHECK(reds(PointShape::circle) == 20);     // all of the nearer one
    CHECK(reds(PointShape::paraboloid) == 16); // 10 on one side, half of 12 on the other
}

TEST_CASE("paraboloids are the reference's where that is sure, and the same in software and GLES", "[gles]") {
    auto* context = eglContext();
    auto gles = context ? GlesRenderer::create() : Result<std::unique_ptr<GlesRenderer>>(Error{});
    auto software = SoftwareRenderer::create(1);
    std::vector<TestNode> nodes{randomNode(1, 4000, 10, {-5, -5, -5}, 0.01),
                                randomNode(2, 2500, 12, {-20, 10, -20}, 0.01)};
    std::size_t unsure = 0, total = 0, beyond = 0;
    for (Projection projection : {Projection::perspective, Projection::orthographic})
        for (double size : {1.0, 2.0, 3.0, 7.3, 40.0, -0.4})
            for (bool edl : {false, true})
                for (bool late : {false, true}) {
                    TestView view;
                    view.position = {1.2345, -17.7, 3.21};
                    view.target = {0.3, 0.1, -0.2};
                    view.projection = projection;
                    view.halfHeight = 9;
                    Style style;
                    style.shape = PointShape::paraboloid;
                    style.sizeMode = size < 0 ? PointSizeMode::world : PointSizeMode::fixed;
                    style.sizePixels = size;
                    style.sizeWorld = -size;
                    style.edl.enabled = edl;
                    style.edl.strength = 0.004;
                    style.delayedExpansion = late ? DelayedExpansion::on : DelayedExpansion::off;
                    INFO("size " << size << " edl " << edl << " late " << late);
                    FramePlan plan = testPlan(nodes, view, style);
                    Image picture = software->render(plan);
                    if (!late) {
                        ReferencePicture expected = referencePicture(nodes, view, style);
                        CHECK(wrongPixels(picture, expected, edl ? 3 : 1) == 0);
                        for (bool pixel : expected.unsure)
                            unsure += pixel;
                        total += expected.unsure.size();
                    }
                    CHECK(SoftwareRenderer::create(3)->render(plan).rgba == picture.rgba);
                    if (!context)
                        continue;
                    REQUIRE(gles.ok());
                    auto apart =
                        measure::pixelError(picture, glesPicture(*context, **gles, plan), edl ? 3 : 2);
                    CHECK(apart.differing <= allowedPixels(*context, picture.rgba.size() / 4));
                    beyond += apart.differing;
                    auto distances = (*gles)->distances(plan);
                    REQUIRE(distances.ok());
                    CHECK(distancesAgree(*context, *distances, software->distances()));
                }
    CHECK(static_cast<double>(unsure) < 0.25 * static_cast<double>(total));
    WARN(unsure << " of " << total << " pixels unsure; " << beyond << " beyond tolerance in GLES");
}
