// Discs along the points' normals (raster_setup.hpp, "Discs"; disc.hpp) against the reference, which has
// arithmetic of its own, and the two renderers against each other. Tolerances: where the reference is sure,
// colours within 1 level (3 with lighting and with splats), distances to a depth step and what 0.01 pixel and
// 1e-4 radian change of the disc's plane there; software and GLES at most 1 pixel in 2000 further apart than
// 2 levels (3 with lighting and with splats), depth steps equal (tests/support/gles.hpp says what a GPU may
// differ by).
#include "client/render/disc.hpp"
#include "client/render/software_renderer.hpp"
#include "tests/support/gles.hpp"
#include "tests/support/reference_picture.hpp"
#include "tests/support/test_plan.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

using namespace stipple;
using namespace stipple::test;

namespace {

struct Scene {
    std::string name;
    std::vector<TestNode> nodes;
    TestView view;
    Style style;
};

// Three nodes, one behind another, the last without normals.
std::vector<TestNode> someNodes() {
    std::vector<TestNode> nodes{randomNode(1, 800, 10, {-5, -5, -5}, 0.01),
                                randomNode(2, 500, 12, {-20, 10, -20}, 0.01),
                                randomNode(3, 100, 9, {1, -8, 0}, 0.01)};
    addNormals(nodes[0], 11);
    addNormals(nodes[1], 12);
    return nodes;
}

Style discs(double sizePixels) {
    Style style;
    style.shape = PointShape::disc;
    style.sizePixels = sizePixels;
    style.edl.enabled = false;
    style.edl.strength = 0.004; // random depths side by side would all turn black at the default
    return style;
}

std::vector<Scene> scenes() {
    std::vector<Scene> all;
    for (Projection projection : {Projection::perspective, Projection::orthographic})
        for (double size : {1.0, 2.0, 3.0, 7.3, 24.0, -0.4})
            for (bool edl : {false, true})
                for (bool splats : {false, true}) {
                    Scene scene{"", someNodes(), {}, discs(std::abs(size))};
                    scene.view.position = {1.2345, -17.7, 3.21};
                    scene.view.target = {0.3, 0.1, -0.2};
                    scene.view.projection = projection;
                    scene.view.halfHeight = 9;
                    scene.style.sizeMode = size < 0 ? PointSizeMode::world : PointSizeMode::fixed;
                    scene.style.sizeWorld = std::abs(size);
                    scene.style.edl.enabled = edl;
                    scene.style.splats.enabled = splats;
                    scene.name = std::string(projection == Projection::perspective ? "perspective "
                                                                                   : "orthographic ") +
                                 std::to_string(size) + (edl ? " EDL" : "") + (splats ? " splats" : "");
                    all.push_back(std::move(scene));
                }
    return all;
}

int levelsOf(const Style& style) {
    return style.edl.enabled || style.splats.enabled ? 3 : 1;
}

struct Tally {
    std::size_t unsure = 0, total = 0, beyond = 0;
    void add(const ReferencePicture& reference) {
        total += reference.unsure.size();
        for (bool pixel : reference.unsure)
            unsure += pixel;
    }
};

// One disc of 20 pixels in the middle of the picture, 10 units away, with that normal.
FramePlan oneDisc(Vec3<float> normal, const Style& style, const TestView& view = {}) {
    TestNode node;
    node.points = {{1 << 15, 1 << 15, 1 << 15}};
    node.points[0].normal = normal;
    node.hasNormals = true;
    node.corner = {-327.68, -327.68, -327.68}; // the point is at the origin
    return testPlan({node}, view, style);
}

// All but 1 in 1000 equal, and those to a step (2^-20 of the distance here).
bool stepsAgree(const headless::EglContext& context, const std::vector<float>& gles,
                const std::vector<float>& software) {
    if (!isExact(context) || gles.size() != software.size())
        return distancesAgree(context, gles, software);
    std::size_t apart = 0;
    float worst = 0;
    for (std::size_t i = 0; i < gles.size(); ++i)
        if (gles[i] != software[i]) {
            ++apart;
            worst = std::max(worst, std::abs(gles[i] / software[i] - 1));
        }
    return apart <= gles.size() / 1000 && worst <= 1e-6f;
}

std::size_t covered(const std::vector<float>& distances) {
    std::size_t count = 0;
    for (float distance : distances)
        count += distance > 0;
    return count;
}

} // namespace

TEST_CASE("discs are the reference's wherever that is sure, and the same in GLES", "[software][gles]") {
    auto* context = eglContext();
    auto gles = context ? GlesRenderer::create()
                        : Result<std::unique_ptr<GlesRenderer>>(Error{ErrorCode::unsupported, "", "", ""});
    auto software = SoftwareRenderer::create(1);
    Tally tally;
    for (const Scene& scene : scenes()) {
        INFO(scene.name);
        FramePlan plan = testPlan(scene.nodes, scene.view, scene.style);
        Image picture = software->render(plan);
        std::vector<float> distances = software->distances();
        ReferencePicture expected = referencePicture(scene.nodes, scene.view, scene.style);
        CHECK(wrongPixels(picture, expected, levelsOf(scene.style)) == 0);
        CHECK(wrongDistances(distances, expected) == 0);
        tally.add(expected);
        CHECK(SoftwareRenderer::create(3)->render(plan).rgba == picture.rgba);
        if (!context)
            continue;
        REQUIRE(gles.ok());
        auto apart = measure::pixelError(picture, glesPicture(*context, **gles, plan),
                                         std::max(2, levelsOf(scene.style)));
        CHECK(apart.differing <= allowedPixels(*context, picture.rgba.size() / 4));
        tally.beyond += apart.differing;
        auto steps = (*gles)->distances(plan);
        REQUIRE(steps.ok());
        CHECK(stepsAgree(*context, *steps, distances));
    }
    CHECK(static_cast<double>(tally.unsure) < 0.25 * static_cast<double>(tally.total));
    WARN(tally.unsure << " of " << tally.total << " pixels unsure; " << tally.beyond
                      << " beyond tolerance in GLES");
}

TEST_CASE("discs that are expanded late are the same in both renderers", "[software][gles]") {
    auto* context = eglContext();
    auto software = SoftwareRenderer::create(1);
    for (Scene& scene : scenes()) {
        INFO(scene.name);
        scene.style.delayedExpansion = DelayedExpansion::on;
        FramePlan plan = testPlan(scene.nodes, scene.view, scene.style);
        Image picture = software->render(plan);
        CHECK(SoftwareRenderer::create(3)->render(plan).rgba == picture.rgba);
        if (!context)
            continue;
        auto gles = GlesRenderer::create();
        REQUIRE(gles.ok());
        auto apart = measure::pixelError(picture, glesPicture(*context, **gles, plan),
                                         std::max(2, levelsOf(scene.style)));
        CHECK(apart.differing <= allowedPixels(*context, picture.rgba.size() / 4));
    }
    // Of points that are alone nothing is lost: late is as at once.
    Style style = discs(20);
    FramePlan plan = oneDisc({1, 2, 0.5f}, style);
    Image atOnce = software->render(plan);
    style.delayedExpansion = DelayedExpansion::on;
    FramePlan late = oneDisc({1, 2, 0.5f}, style);
    CHECK(software->render(late).rgba == atOnce.rgba);
}

TEST_CASE("a disc is foreshortened by its tilt, on either side", "[software]") {
    auto renderer = SoftwareRenderer::create(1);
    TestView view;
    view.projection = Projection::orthographic; // half a height of 5 units in 120 pixels
    for (double degrees : {0.0, 30.0, 60.0, 80.0}) {
        double angle = degrees * std::numbers::pi / 180, radius = 20;
        auto across = static_cast<float>(std::sin(angle)), along = static_cast<float>(std::cos(angle));
        FramePlan plan = oneDisc({across, -along, 0}, discs(2 * radius), view);
        Image front = renderer->render(plan);
        std::vector<float> distances = renderer->distances();
        double area = std::numbers::pi * radius * radius * std::cos(angle);
        CHECK(static_cast<double>(covered(distances)) == Approx(area).epsilon(0.06));
        std::erase(distances, 0.0f);
        auto [least, most] = std::minmax_element(distances.begin(), distances.end());
        double deep =
            radius * std::sin(angle) / 12; // world units; a pixel's centre is half a pixel from the edge
        CHECK(10 - double{*least} == Approx(deep).margin(0.05 + 0.08 * std::tan(angle)));
        CHECK(double{*most} - 10 == Approx(deep).margin(0.05 + 0.08 * std::tan(angle)));
        FramePlan back = oneDisc({-across, along, 0}, discs(2 * radius), view);
        CHECK(renderer->render(back).rgba == front.rgba);
    }
}

TEST_CASE("a point without a direction is a circle, and so is one that faces the camera", "[software]") {
    auto renderer = SoftwareRenderer::create(1);
    for (Projection projection : {Projection::perspective, Projection::orthographic})
        for (double size : {2.0, 5.0, 33.3}) {
            TestView view;
            view.projection = projection;
            Style circles = discs(size);
            circles.shape = PointShape::circle;
            FramePlan plan = oneDisc({}, circles, view);
            Image expected = renderer->render(plan);
            std::vector<float> distances = renderer->distances();
            for (Vec3<float> normal : {Vec3<float>{}, Vec3<float>{0, NAN, 1}, Vec3<float>{0, INFINITY, 0},
                                       Vec3<float>{0, -2, 0}}) {
                FramePlan same = oneDisc(normal, discs(size), view);
                CHECK(renderer->render(same).rgba == expected.rgba);
                CHECK(renderer->distances() == distances);
            }
        }
}

TEST_CASE("a cloud without normals is drawn as circles, to the bit", "[software]") {
    auto renderer = SoftwareRenderer::create(1);
    std::vector<TestNode> nodes = someNodes();
    for (TestNode& node : nodes)
        node.hasNormals = false;
    for (bool splats : {false, true}) {
        Style style = discs(5);
        style.splats.enabled = splats;
        FramePlan plan = testPlan(nodes, {}, style);
        Image picture = renderer->render(plan);
        style.shape = PointShape::circle;
        FramePlan circles = testPlan(nodes, {}, style);
        CHECK(renderer->render(circles).rgba == picture.rgba);
    }
}

TEST_CASE("a disc that is seen along its plane shows its point all the same", "[software][gles]") {
    auto* context = eglContext();
    auto renderer = SoftwareRenderer::create(1);
    for (Projection projection : {Projection::perspective, Projection::orthographic})
        for (double away : {0.0, 1e-9, 1e-7, 1e-5, 1e-4, 1e-3}) {
            TestView view;
            view.projection = projection;
            FramePlan plan = oneDisc({1, static_cast<float>(away), 0}, discs(30), view);
            Image picture = renderer->render(plan);
            std::vector<float> distances = renderer->distances();
            std::size_t shown = covered(distances);
            INFO("turned by " << away);
            CHECK(shown >= 1);
            CHECK(shown <= 31);
            for (float distance : distances)
                if (distance > 0)
                    CHECK(double{distance} == Approx(10).margin(2.6)); // the radius is 2.5 at most
            if (!context)
                continue;
            auto gles = GlesRenderer::create();
            REQUIRE(gles.ok());
            CHECK(measure::pixelError(picture, glesPicture(*context, **gles, plan), 2).differing <= 1);
        }
}

TEST_CASE("no point of a cloud with normals vanishes", "[software]") {
    // Each on a pixel of its own, so none can hide another.
    TestNode node;
    node.nodeBits = 16;
    node.corner = {-327.68, -327.68, -327.68};
    TestRandom random(5);
    for (int row = 0; row < 10; ++row)
        for (int column = 0; column < 10; ++column)
            node.points.push_back(
                {static_cast<std::uint32_t>((1 << 15) + 80 * (column - 5) + random.below(60)), 1 << 15,
                 static_cast<std::uint32_t>((1 << 15) + 60 * (row - 5) + random.below(40))});
    addNormals(node, 3);
    auto renderer = SoftwareRenderer::create(1);
    for (double size : {1.01, 1.5, 2.0, 3.0, 6.0}) {
        FramePlan plan = testPlan({node}, {}, discs(size));
        std::vector<bool> seen(node.points.size());
        for (int y = 0; y < plan.height; ++y)
            for (int x = 0; x < plan.width; ++x)
                if (auto hit = renderer->pick(plan, {x + 0.5, y + 0.5, 0}))
                    seen[hit->point] = true;
        CHECK(std::count(seen.begin(), seen.end(), false) == 0);
    }
}

TEST_CASE("discs across the near plane, and with fields of view from 0.5 to 170 degrees, are the reference's",
          "[software][gles][numerics]") {
    auto* context = eglContext();
    auto renderer = SoftwareRenderer::create(1);
    Tally tally;
    for (double degrees : {0.5, 5.0, 60.0, 120.0, 170.0})
        for (double size : {3.0, 12.0, 40.0})
            for (bool nearby : {false, true}) {
                Scene scene{"", {randomNode(1, 60, 10, {-5, -5, -5}, 0.01)}, {}, discs(size)};
                addNormals(scene.nodes[0], 9);
                double tangent = std::tan(degrees * std::numbers::pi / 360);
                double distance = nearby ? 4 : std::max(6.0, 5 / tangent);
                scene.view.tanHalfFovY = tangent;
                scene.view.position = {0.21, -distance, 0.37};
                scene.view.near = nearby ? 0.5 : distance / 100;
                scene.view.far = distance + 20;
                INFO(degrees << " degrees, " << size << " pixels, nearby " << nearby);
                FramePlan plan = testPlan(scene.nodes, scene.view, scene.style);
                Image picture = renderer->render(plan);
                ReferencePicture expected = referencePicture(scene.nodes, scene.view, scene.style);
                CHECK(wrongPixels(picture, expected, 1) == 0);
                CHECK(wrongDistances(renderer->distances(), expected) == 0);
                tally.add(expected);
                if (!context)
                    continue;
                auto gles = GlesRenderer::create();
                REQUIRE(gles.ok());
                auto apart = measure::pixelError(picture, glesPicture(*context, **gles, plan), 2);
                CHECK(apart.differing <= allowedPixels(*context, picture.rgba.size() / 4));
                tally.beyond += apart.differing;
            }
    CHECK(static_cast<double>(tally.unsure) < 0.25 * static_cast<double>(tally.total));
    std::printf("discs, 0.5 to 170 degrees: %zu of %zu pixels unsure, %zu beyond tolerance in GLES\n",
                tally.unsure, tally.total, tally.beyond);
}

TEST_CASE("discs take their sizes from the octree and from continuous detail, and stay hidden where they are",
          "[software][gles]") {
    auto* context = eglContext();
    auto renderer = SoftwareRenderer::create(1);
    std::vector<TestNode> octree = randomOctree(3, 3, 150, 12, {-20, -20, -20}, 0.01);
    for (std::size_t i = 0; i < octree.size(); ++i)
        addNormals(octree[i], i);
    TestView view;
    view.position = {3, -60, 20};
    view.far = 200;
    std::vector<Style> styles(4, discs(6));
    styles[0].sizeMode = PointSizeMode::adaptive;
    styles[0].sizeSpacings = 0.3;
    styles[1].detail = {DetailMode::continuous, 4};
    styles[1].sizeMode = PointSizeMode::spacing;
    styles[2].filters = {{"Intensity", 1000, 3000}};
    styles[3].clipBoxes.push_back({{0, 0, 0}, {8, 8, 8}, axesTurned(20), ClipMode::hideInside});
    styles[3].splats.enabled = true;
    for (std::size_t i = 0; i < styles.size(); ++i) {
        INFO("style " << i);
        FramePlan plan = testPlan(octree, view, styles[i]);
        if (styles[i].detail.mode == DetailMode::continuous)
            plan.detailPixels = styles[i].detail.spacingPixels;
        Image picture = renderer->render(plan);
        CHECK(covered(renderer->distances()) > 1000);
        if (styles[i].detail.mode == DetailMode::discrete) {
            ReferencePicture expected = referencePicture(octree, view, styles[i]);
            CHECK(wrongPixels(picture, expected, levelsOf(styles[i])) == 0);
        }
        if (!context)
            continue;
        auto gles = GlesRenderer::create();
        REQUIRE(gles.ok());
        auto apart = measure::pixelError(picture, glesPicture(*context, **gles, plan), 3);
        CHECK(apart.differing <= allowedPixels(*context, picture.rgba.size() / 4));
        plan.style.shape = PointShape::circle; // the same nodes: normals are let go
        paintPlan(plan, octree);
        FramePlan circles = testPlan(octree, view, plan.style);
        circles.detailPixels = plan.detailPixels;
        Image expected = renderer->render(circles);
        apart = measure::pixelError(expected, glesPicture(*context, **gles, plan), 3);
        CHECK(apart.differing <= allowedPixels(*context, expected.rgba.size() / 4));
    }
}
