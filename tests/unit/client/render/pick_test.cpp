// What is under the pointer, by both rasterizers, against looking at every point (tests/support).
#include "client/render/pick.hpp"
#include "client/render/software_renderer.hpp"
#include "tests/support/gles.hpp"
#include "tests/support/reference_picture.hpp"
#include "tests/support/test_plan.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::test;

namespace {

struct Scene {
    std::vector<TestNode> nodes;
    TestView view;
    Style style;
};

std::vector<TestNode> someNodes() {
    std::vector<TestNode> nodes{randomNode(1, 700, 10, {-5, -5, -5}, 0.01),
                                randomNode(2, 400, 12, {-20, 10, -20}, 0.01),
                                randomNode(3, 100, 9, {1, -8, 0}, 0.01)};
    addNormals(nodes[0], 1);
    addNormals(nodes[1], 2);
    return nodes;
}

std::vector<Scene> scenes() {
    std::vector<Scene> all;
    for (Projection projection : {Projection::perspective, Projection::orthographic})
        for (PointShape shape : {PointShape::square, PointShape::circle, PointShape::disc})
            for (double size : {1.0, 2.0, 3.0, 6.3, -0.3}) {
                Scene scene;
                scene.nodes = someNodes();
                scene.view.position = {1.2345, -17.7, 3.21};
                scene.view.target = {0.3, 0.1, -0.2};
                scene.view.projection = projection;
                scene.view.halfHeight = 9;
                scene.style.shape = shape;
                scene.style.sizeMode = size < 0 ? PointSizeMode::world : PointSizeMode::fixed;
                scene.style.sizePixels = size;
                scene.style.sizeWorld = -size;
                all.push_back(std::move(scene));
            }
    return all;
}

std::vector<PickRequest> requestsFor(const TestView& view, int count) {
    TestRandom random(17);
    std::vector<PickRequest> requests;
    for (int i = 0; i < count; ++i)
        requests.push_back({random.unit() * (view.width + 20) - 10, random.unit() * (view.height + 20) - 10,
                            static_cast<int>(random.below(12))});
    return requests;
}

// Picks of one scene against the reference; `pick` answers.
struct Tally {
    int picks = 0, equal = 0;
};
template <class Pick>
void checkPicks(const Scene& scene, int count, Tally& tally, const Pick& pick) {
    FramePlan plan = testPlan(scene.nodes, scene.view, scene.style);
    ReferencePoints reference = referencePoints(scene.nodes, scene.view, scene.style);
    for (const PickRequest& request : requestsFor(scene.view, count)) {
        INFO("at " << request.x << ", " << request.y << " radius " << request.radius);
        ExpectedPick expected = expectedPick(reference, request);
        bool equal = orderOf(pick(plan, request), plan) == expected.order;
        CHECK((equal || !expected.isSure));
        ++tally.picks;
        tally.equal += equal;
    }
}

} // namespace

TEST_CASE("the software renderer picks the point that looking at all of them finds", "[software]") {
    auto renderer = SoftwareRenderer::create(1);
    Tally tally;
    for (const Scene& scene : scenes())
        checkPicks(scene, 100, tally, [&](const FramePlan& plan, const PickRequest& request) {
            return renderer->pick(plan, request);
        });
    CHECK(tally.equal > 0.99 * tally.picks);
}

TEST_CASE("GLES picks the point that looking at all of them finds", "[gles]") {
    auto* context = eglContext();
    if (!context)
        return;
    auto gles = GlesRenderer::create();
    REQUIRE(gles.ok());
    Tally tally;
    for (const Scene& scene : scenes())
        checkPicks(scene, 40, tally, [&](const FramePlan& plan, const PickRequest& request) {
            REQUIRE((*gles)->startPick(plan, request).ok());
            for (;;) {
                auto answer = (*gles)->takePick();
                REQUIRE(answer.ok());
                if (*answer)
                    return (*answer)->hit;
            }
        });
    CHECK(tally.equal > 0.99 * tally.picks);
}

TEST_CASE("a pick says how near the pixel and how far the point is") {
    TestNode node;
    node.points = {{1 << 15, 1 << 15, 1 << 15}};
    node.corner = {-327.68, -327.68, -327.68}; // the point is at the origin
    FramePlan plan = testPlan({node}, {});
    auto renderer = SoftwareRenderer::create(1);
    auto hit = renderer->pick(plan, {80, 60, 4});
    REQUIRE(hit);
    CHECK(hit->point == 0);
    CHECK(hit->node == plan.nodes[0].node);
    CHECK(hit->distance == Approx(10).epsilon(1e-5));
    CHECK(hit->pixelsAway < 1);
    CHECK_FALSE(renderer->pick(plan, {90, 60, 4}));
    CHECK(renderer->pick(plan, {90, 60, 12}));
    CHECK_FALSE(renderer->pick(plan, {-1000, 60, 12}));
    CHECK_FALSE(renderer->pick(plan, {std::nan(""), 60, 12}));
    CHECK_FALSE(renderer->pick(FramePlan{}, {0, 0, 12}));
}

TEST_CASE("only nodes that can be under the pointer are drawn for a pick") {
    std::vector<TestNode> nodes;
    for (int i = 0; i < 20; ++i)
        nodes.push_back(randomNode(1 + static_cast<std::uint64_t>(i), 50, 10, {-100.0 + 10 * i, 0, 0}, 0.01));
    TestView view;
    view.position = {0, -200, 5};
    view.target = {0, 0, 5};
    FramePlan plan = testPlan(nodes, view);
    PickTarget target = pickTarget(plan, {80, 60, 2});
    CHECK(target.nodes.size() >= 1);
    CHECK(target.nodes.size() <= 4);
    CHECK(pickTarget(plan, {5000, 60, 2}).nodes.empty());
}

TEST_CASE("a question about the pointer takes the place of one that was not answered", "[gles]") {
    auto* context = eglContext();
    if (!context)
        return;
    auto gles = GlesRenderer::create();
    REQUIRE(gles.ok());
    Scene scene = scenes()[6];
    FramePlan plan = testPlan(scene.nodes, scene.view, scene.style);
    CHECK_FALSE((*gles)->pickPending());
    auto nothing = (*gles)->takePick();
    REQUIRE(nothing.ok());
    CHECK_FALSE(nothing->has_value());
    REQUIRE((*gles)->startPick(plan, {80, 60, 64}).ok());
    REQUIRE((*gles)->startPick(plan, {-500, 60, 8}).ok());
    CHECK((*gles)->pickPending());
    std::optional<PickAnswer> answer;
    while (!answer) {
        auto taken = (*gles)->takePick();
        REQUIRE(taken.ok());
        answer = *taken;
    }
    CHECK_FALSE(answer->hit);
    CHECK_FALSE((*gles)->pickPending());
    CHECK_FALSE((*gles)->takePick()->has_value());
}

namespace {

// Scenes of delayed expansion whose points have a colour each, so that a pixel says which point it shows.
std::vector<Scene> lateScenes() {
    std::vector<Scene> all;
    for (PointShape shape :
         {PointShape::square, PointShape::circle, PointShape::paraboloid, PointShape::disc})
        for (PointSizeMode mode : {PointSizeMode::fixed, PointSizeMode::world, PointSizeMode::adaptive})
            for (Projection projection : {Projection::perspective, Projection::orthographic}) {
                Scene scene;
                scene.nodes = randomOctree(21, 2, 2000, 12, {-5, -5, -5}, 10.0 / 4096);
                scene.view.position = {1.2345, -17.7, 3.21};
                scene.view.target = {0.3, 0.1, -0.2};
                scene.view.projection = projection;
                scene.view.halfHeight = 9;
                scene.style.edl.enabled = false;
                scene.style.shape = shape;
                scene.style.sizeMode = mode;
                scene.style.sizePixels = 7.3;
                scene.style.sizeWorld = 0.5;
                scene.style.sizeSpacings = 0.6;
                scene.style.delayedExpansion = DelayedExpansion::on;
                std::uint32_t number = 0;
                for (TestNode& node : scene.nodes) {
                    addNormals(node, number);
                    for (TestPoint& point : node.points) {
                        ++number;
                        point.r = static_cast<std::uint8_t>(number & 255);
                        point.g = static_cast<std::uint8_t>(number >> 8 & 255);
                        point.b = static_cast<std::uint8_t>(number >> 16);
                    }
                }
                all.push_back(std::move(scene));
            }
    return all;
}

// The number of the point that a pixel shows; 0: none.
std::uint32_t shownAt(const Image& picture, const Style& style, int x, int y) {
    const std::uint8_t* at = picture.rgba.data() + 4 * (y * picture.width + x);
    bool empty = std::equal(style.background.begin(), style.background.end(), at);
    return empty ? 0 : at[0] | std::uint32_t{at[1]} << 8 | std::uint32_t{at[2]} << 16;
}

// Picks on single pixels against the picture; counts those where drawing at once shows another point.
template <class Draw, class Pick>
void checkLatePicks(const Scene& scene, int count, int& otherwise, const Draw& draw, const Pick& pick) {
    FramePlan plan = testPlan(scene.nodes, scene.view, scene.style);
    FramePlan atOnce = plan;
    atOnce.style.delayedExpansion = DelayedExpansion::off;
    Image picture = draw(plan), whole = draw(atOnce);
    TestRandom random(5);
    for (int i = 0; i < count; ++i) {
        int x = static_cast<int>(random.below(160)), y = static_cast<int>(random.below(120));
        std::uint32_t shown = shownAt(picture, scene.style, x, y);
        INFO("at " << x << ", " << y);
        CHECK(orderOf(pick(plan, PickRequest{x + 0.5, y + 0.5, 0}), plan) == shown);
        otherwise += shown != shownAt(whole, scene.style, x, y);
    }
}

} // namespace

TEST_CASE("with delayed expansion the software renderer picks what the picture shows", "[software]") {
    auto renderer = SoftwareRenderer::create(2);
    int otherwise = 0;
    for (const Scene& scene : lateScenes())
        checkLatePicks(
            scene, 200, otherwise, [&](FramePlan& plan) { return renderer->render(plan); },
            [&](const FramePlan& plan, const PickRequest& request) { return renderer->pick(plan, request); });
    CHECK(otherwise > 50); // or the scenes would not tell one from the other
    WARN(otherwise << " of 3600 pixels show another point than at once");
}

TEST_CASE("with delayed expansion GLES picks what the picture shows", "[gles]") {
    auto* context = eglContext();
    if (!context)
        return;
    auto gles = GlesRenderer::create();
    REQUIRE(gles.ok());
    int otherwise = 0;
    for (const Scene& scene : lateScenes())
        checkLatePicks(
            scene, 60, otherwise, [&](FramePlan& plan) { return glesPicture(*context, **gles, plan); },
            [&](const FramePlan& plan, const PickRequest& request) {
                REQUIRE((*gles)->startPick(plan, request).ok());
                for (;;) {
                    auto answer = (*gles)->takePick();
                    REQUIRE(answer.ok());
                    if (*answer)
                        return (*answer)->hit;
                }
            });
    CHECK(otherwise > 10);
}
