// The renderers against each other and against the reference, over colour modes, mixtures, filters, hidden
// classes, clip boxes and clip regions.
//
// The stated tolerance: where the reference is sure, the software picture has its colours within 1 level for
// colours that come from tables, 4 where they go along a gradient (one entry of it), 2 for highlights (halves
// are cut off). What is hidden is hidden in both, so distances agree wherever the reference is sure. Software
// and GLES take the same decided colours: at most 1 pixel in 2000 is further apart than 2 levels (a position
// that rounds to another 1/128 pixel), and distances are equal.
#include "client/render/software_renderer.hpp"
#include "tests/support/gles.hpp"
#include "tests/support/reference_picture.hpp"
#include "tests/support/test_plan.hpp"

#include <cmath>
#include <functional>
#include <limits>

using namespace stipple;
using namespace stipple::test;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Scene {
    std::string name;
    Style style;
    int tolerance = 4;
};

std::vector<TestNode> nodes() {
    std::vector<TestNode> made{randomNode(1, 4000, 10, {-5, -5, -5}, 0.01),
                               randomNode(2, 2500, 12, {-20, 10, -20}, 0.01),
                               randomNode(3, 500, 9, {1, -8, 0}, 0.01),
                               randomNode(4, 800, 24, {-4, -7, -4}, 5e-7)}; // with low words
    made[1].hasIntensity = false;
    made[2].hasColour = false;
    return made;
}

TestView view() {
    TestView made;
    made.position = {1.2345, -17.7, 3.21};
    made.target = {0.3, 0.1, -0.2};
    return made;
}

ClipBox box(ClipMode mode, Vec3d centre, Vec3d half, double x, double y, double z, double w) {
    ClipBox made{centre, half};
    made.mode = mode;
    made.axes = *axesOfQuaternion(x, y, z, w);
    return made;
}

std::vector<Scene> scenes() {
    std::vector<Scene> all;
    auto add = [&](const char* name, int tolerance, const std::function<void(Style&)>& set) {
        Scene scene{name, {}, tolerance};
        scene.style.gradient = GradientName::turbo;
        scene.style.edl.enabled = false;
        scene.style.intensityRange = {200, 3800};
        scene.style.elevationRange = {-12, 9};
        scene.style.levelRange = {0, 12};
        scene.style.attributeRange = {0, 4095};
        set(scene.style);
        all.push_back(std::move(scene));
    };
    add("classification", 1, [](Style& s) { s.colourMode = ColourMode::classification; });
    add("GPS time", 4, [](Style& s) {
        s.colourMode = ColourMode::gpsTime;
        s.attributeRange = {390583952.3, 390583952.4};
    });
    add("an attribute by name", 4, [](Style& s) {
        s.colourMode = ColourMode::attribute;
        s.attribute = "intensity";
    });
    add("an attribute that nobody has", 1, [](Style& s) {
        s.colourMode = ColourMode::attribute;
        s.attribute = "Amplitude";
    });
    add("level", 4, [](Style& s) { s.colourMode = ColourMode::level; });
    add("mix", 4, [](Style& s) {
        s.colourMode = ColourMode::mix;
        s.mix = {{ColourMode::rgb, "", {}, 3},
                 {ColourMode::intensity, "", {0, 4095}, 1},
                 {ColourMode::classification, "", {}, 0.5}};
    });
    add("hidden classes", 1, [](Style& s) {
        for (std::size_t c : {2, 5, 6, 7})
            s.hiddenClasses.set(c);
    });
    add("intensity filter", 1, [](Style& s) { s.filters = {{"INTENSITY", 1000, 2500}}; });
    add("two open filters", 4, [](Style& s) {
        s.colourMode = ColourMode::intensity;
        s.filters = {{"Intensity", 1000, infinity}, {"GPS Time", -infinity, 390583952.35}};
    });
    add("filter on what nobody has", 1, [](Style& s) { s.filters = {{"Amplitude", 5, 6}}; });
    add("hide outside two boxes", 1, [](Style& s) {
        s.clipBoxes = {box(ClipMode::hideOutside, {0, 0, 0}, {3, 3, 1}, 0.1, 0.2, 0.3, 0.9),
                       box(ClipMode::hideOutside, {-8, 20, -8}, {6, 6, 6}, 0, 0, 0, 1)};
    });
    add("hide inside", 4, [](Style& s) {
        s.colourMode = ColourMode::elevation;
        s.clipBoxes = {box(ClipMode::hideInside, {0, 0, 0}, {3, 1, 4}, 0.5, 0.1, 0.3, 0.4)};
    });
    add("all kinds of boxes, and a filter", 2, [](Style& s) {
        s.clipBoxes = {box(ClipMode::hideOutside, {0, 0, 0}, {9, 30, 9}, 0, 0, 0.2, 1),
                       box(ClipMode::hideInside, {1, -2, 0}, {1, 2, 1}, 0.3, 0, 0, 1),
                       box(ClipMode::highlight, {-2, 0, 0}, {2, 20, 2}, 0, 0.4, 0, 1)};
        s.hiddenClasses.set(11);
    });
    // Its numbers lie off the points' grid: the reference takes places as they are, not rounded to double.
    add("hide outside a footprint with a hole", 1, [](Style& s) {
        s.clipRegions = {{}};
        s.clipRegions[0].shape.rings = {
            {{-6.003, -6.007}, {7.001, -5.004}, {1.002, 0.003}, {6.004, 8.001}, {-5.006, 5.002}},
            {{-2.004, -3.003}, {1.001, -3.002}, {-1.003, 1.006}}};
        s.clipRegions[0].shape.heights = ValueRange{-3.003, 2.502};
    });
    add("hide inside a prism in perspective", 4, [](Style& s) {
        s.colourMode = ColourMode::elevation;
        s.clipRegions = {{{}, ClipMode::hideInside}};
        s.clipRegions[0].shape.prism = ScreenPolygon{
            Vec3d{5, -20, 9}, {-0.2, 1, -0.4}, {{-2, 0, -2}, {3, 0, -2}, {1, 0, 0}, {3, 0, 3}, {-2, 0, 2}}};
    });
    add("a corridor and a prism of parallel rays", 2, [](Style& s) {
        s.clipRegions = {{}, {{}, ClipMode::highlight}, {{}, ClipMode::hideInside}};
        s.clipRegions[0].shape.line = {{-9, -4}, {2, -3}, {3, 6}, {2.5, -9}};
        s.clipRegions[0].shape.width = 5;
        s.clipRegions[1].shape.prism =
            ScreenPolygon{std::nullopt, {0.3, 1, 0}, {{-2, 0, -2}, {3, 0, -2}, {3, 0, 3}}};
        s.clipRegions[2].shape.box = RegionShape::Box{{0, 0, 0}, {1, 30, 1}, axesTurned(30)};
    });
    std::vector<Scene> sized;
    for (const Scene& scene : all)
        for (double size : {1.0, 3.0, 5.5}) {
            sized.push_back(scene);
            sized.back().style.sizePixels = size;
            sized.back().name += " " + std::to_string(size);
        }
    return sized;
}

} // namespace

TEST_CASE("colours and hidden points are the reference's wherever that is sure", "[software]") {
    auto renderer = SoftwareRenderer::create(2);
    std::vector<std::size_t> covered;
    for (const Scene& scene : scenes()) {
        INFO(scene.name);
        ReferencePicture reference = referencePicture(nodes(), view(), scene.style);
        FramePlan plan = testPlan(nodes(), view(), scene.style);
        const Image& image = renderer->render(plan);
        CHECK(wrongPixels(image, reference, scene.tolerance) == 0);
        std::vector<float> distances = renderer->distances();
        CHECK(wrongDistances(distances, reference) == 0);
        std::size_t shown = 0;
        for (float distance : distances)
            shown += distance > 0;
        CHECK(shown > 300);
        covered.push_back(shown);
    }
    // What hides, hides: less of the picture is covered than without.
    std::size_t plain = covered[0];
    for (std::size_t i : {18, 21, 24, 30, 33, 36, 39, 42, 45})
        CHECK(covered[i] < plain);
    CHECK(covered[27] == plain); // the filter on what nobody has
}

TEST_CASE("software and GLES hide and colour alike", "[gles]") {
    auto* context = eglContext();
    if (!context)
        return;
    auto gles = GlesRenderer::create();
    REQUIRE(gles.ok());
    auto software = SoftwareRenderer::create(1);
    int largest = 0;
    for (const Scene& scene : scenes()) {
        INFO(scene.name);
        FramePlan plan = testPlan(nodes(), view(), scene.style);
        Image a = software->render(plan);
        Image b = glesPicture(*context, **gles, plan);
        measure::PixelError apart = measure::pixelError(a, b, 2);
        CHECK(apart.differing * 2000 <= a.rgba.size() / 4);
        auto distances = (*gles)->distances(plan);
        REQUIRE(distances.ok());
        CHECK(*distances == software->distances());
        largest = std::max(largest, static_cast<int>(apart.largest));
    }
    WARN("largest difference " << largest << " levels");
}

TEST_CASE("a paint that changes is uploaded in place of the one before", "[gles]") {
    auto* context = eglContext();
    if (!context)
        return;
    auto gles = GlesRenderer::create();
    REQUIRE(gles.ok());
    auto software = SoftwareRenderer::create(1);
    FramePlan plan = testPlan(nodes(), view(), {});
    std::uint64_t bytes = 0;
    for (const Scene& scene : scenes()) {
        INFO(scene.name);
        plan.style = scene.style;
        paintPlan(plan, nodes());
        Image b = glesPicture(*context, **gles, plan);
        Image a = software->render(plan);
        CHECK(measure::pixelError(a, b, 2).differing * 2000 <= a.rgba.size() / 4);
        CHECK((bytes == 0 || (*gles)->gpuBytes() <= bytes + 4 * 500)); // 500 points without a colour
        bytes = bytes == 0 ? (*gles)->gpuBytes() : bytes;
    }
}
