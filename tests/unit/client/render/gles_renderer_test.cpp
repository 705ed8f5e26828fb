#include "client/render/gles_objects.hpp"
#include "client/render/gles_renderer.hpp"
#include "tests/support/gles.hpp"
#include "tests/support/test_plan.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {

std::array<int, 3> pixel(const Image& image, int x, int y) {
    std::size_t at = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                          static_cast<std::size_t>(x));
    return {image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]};
}

} // namespace

TEST_CASE("a point appears where the camera projects it, in its colour", "[gles]") {
    auto* context = eglContext();
    if (!context)
        return;
    auto renderer = GlesRenderer::create();
    REQUIRE(renderer.ok());
    TestNode node;
    node.points = {{100, 0, 200, 10, 200, 30, 0}}; // world (1, 0, 2)
    TestView view;                                 // from (0, -10, 0), half height 5 at distance 10
    Style style;
    style.edl.enabled = false;
    style.sizePixels = 1;
    FramePlan plan = testPlan({node}, view, style);
    Image image = glesPicture(*context, **renderer, plan);
    // 12 pixels a unit: x = 80 + 12, y = 60 - 24.
    CHECK(pixel(image, 92, 35) == std::array<int, 3>{10, 200, 30});
    CHECK(pixel(image, 91, 35) == std::array<int, 3>{24, 26, 30});
    CHECK(pixel(image, 92, 36) == std::array<int, 3>{24, 26, 30});
    CHECK(plan.counters.passesRun == 1);
    CHECK(plan.counters.passesSkipped == 1);
    CHECK(gles::checkGl("testing").ok());
}
