// What each skip saves and what it costs in error, for one cloud and view: skip_table CLOUD.stipple
// [CAMERA-JSON]. Prints a Markdown table: nodes, points and bytes without the skip and with it; how long
// drawing takes with it as part of what it takes without (one thread, in turns, so the ratio holds on a busy
// machine); the error against the picture without it, levels of 255, and pixels that differ. Ends with 1
// where a skip that is to change nothing does.
#include "client/bench/statistics.hpp"
#include "client/core/frustum.hpp"
#include "client/core/json.hpp"
#include "client/measure/pixel_error.hpp"
#include "client/render/software_renderer.hpp"
#include "shared/geometry/oriented_box.hpp"
#include "tests/bench/settled_viewer.hpp"
#include "tests/bench/whole_cloud.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

using namespace stipple;

namespace {

constexpr int width = 1920, height = 1080, rounds = 7;
constexpr double minNodePixels = 60;

double seconds(const std::function<void()>& work) {
    auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// What is drawn and what was fetched for it.
struct Work {
    FramePlan plan;
    double bytes = 0;
    double points() const {
        double sum = 0;
        for (const DrawNode& node : plan.nodes)
            sum += node.pointCount;
        return sum;
    }
};

enum class Promise { exact, near }; // what the skip is to do to the picture: nothing, or little

class Table {
  public:
    Table() {
        std::printf("| skip | nodes | points | MB fetched | drawing takes | mean error, pixels |\n"
                    "|---|---|---|---|---|---|\n");
    }
    void add(const std::string& skip, Work& without, Work& with, Promise promise) {
        Image whole = renderer_->render(without.plan), skipped = renderer_->render(with.plan);
        measure::PixelError apart = measure::pixelError(whole, skipped, 0);
        std::vector<double> ratios;
        for (int i = 0; i < rounds; ++i) {
            double before = seconds([&] { renderer_->render(without.plan); });
            ratios.push_back(seconds([&] { renderer_->render(with.plan); }) / before);
        }
        std::printf("| %s | %zu → %zu | %.2f M → %.2f M | %.2f → %.2f | %.3f | %.4g, %llu |\n", skip.c_str(),
                    without.plan.nodes.size(), with.plan.nodes.size(), without.points() / 1e6,
                    with.points() / 1e6, without.bytes / 1e6, with.bytes / 1e6, bench::median(ratios),
                    apart.mean, static_cast<unsigned long long>(apart.differing));
        if (promise == Promise::exact && apart.differing > 0) {
            std::fprintf(stderr, "skip_table: '%s' is to change nothing, but %llu pixels differ\n",
                         skip.c_str(), static_cast<unsigned long long>(apart.differing));
            broken_ = true;
        }
    }
    bool broken() const { return broken_; }

  private:
    std::unique_ptr<SoftwareRenderer> renderer_ = SoftwareRenderer::create(1);
    bool broken_ = false;
};

struct Scene {
    WholeCloud cloud;
    Camera camera;

    Work work(const std::vector<NodePart>& parts, const Style& style) const {
        return {cloud.planOf(parts, camera, style), cloud.bytesOf(parts, style)};
    }
    std::vector<NodePart> large(const Clips* clips = nullptr) const {
        return cloud.selected(camera, minNodePixels, 0, clips);
    }
};

// Circles, whose edges reach into the picture from outside, and single pixels, which don't.
void frustum(const Scene& scene, Table& table) {
    const Hierarchy& hierarchy = scene.cloud.hierarchy();
    ViewTransform view = scene.cloud.viewOf(scene.camera);
    std::vector<NodePart> anywhere;
    for (std::uint32_t i = 0; i < hierarchy.size(); ++i) {
        const HierarchyNode& node = hierarchy.node(i);
        if (i == 0 ||
            projectedPixels(view, height, node.geometry.centre, node.geometry.radius) >= minNodePixels)
            anywhere.push_back({i, node.entry.pointCount});
    }
    std::vector<NodePart> seen = scene.large();
    Style circles, pixels;
    pixels.sizePixels = 1;
    pixels.edl.enabled = false;
    Work all = scene.work(anywhere, pixels), some = scene.work(seen, pixels);
    table.add("frustum, points of 1 pixel", all, some, Promise::exact);
    all = scene.work(anywhere, circles);
    some = scene.work(seen, circles);
    table.add("frustum, circles of 2 pixels", all, some, Promise::near);
}

void size(const Scene& scene, Table& table) {
    Work all = scene.work(scene.cloud.selected(scene.camera, 0), {}), some = scene.work(scene.large(), {});
    table.add("size: nodes under 60 pixels", all, some, Promise::near);
}

void prefix(const Scene& scene, Table& table) {
    Style style;
    style.detail.mode = DetailMode::continuous;
    style.detail.spacingPixels = 1;
    std::vector<NodePart> prefixes = scene.cloud.selected(scene.camera, 0, 1), whole = prefixes;
    for (NodePart& part : whole)
        part.points = scene.cloud.hierarchy().node(part.node).entry.pointCount;
    Work all = scene.work(whole, style), some = scene.work(prefixes, style);
    table.add("prefix: continuous detail, 1 pixel", all, some, Promise::exact);
}

void clip(Scene& scene, Table& table) {
    BoxD bounds = scene.cloud.metadata().worldBounds();
    Style style;
    style.clipBoxes = {{(bounds.min + bounds.max) * 0.5, (bounds.max - bounds.min) * 0.25, axesTurned(30)}};
    for (ClipMode mode : {ClipMode::hideOutside, ClipMode::hideInside}) {
        style.clipBoxes[0].mode = mode;
        Clips clips = need(Clips::make(style.clipBoxes));
        scene.cloud.hideBy(style);
        Work all = scene.work(scene.large(), style), some = scene.work(scene.large(&clips), style);
        table.add(mode == ClipMode::hideOutside ? "clip: hide outside a turned box of half the sides"
                                                : "clip: hide inside it",
                  all, some, Promise::exact);
    }
}

// One whose values lie together, if the cloud has any: then a filter hides whole nodes.
const Attribute* filteredAttribute(const CloudMetadata& metadata, AttributeStatistics& values) {
    for (std::string_view name : {attribute_names::pointSourceId, attribute_names::gpsTime,
                                  attribute_names::intensity, attribute_names::red})
        if (int at = findAttribute(metadata.schema, name); at >= 0) {
            auto index = static_cast<std::size_t>(at);
            if (index < metadata.statistics.size() &&
                metadata.statistics[index].min < metadata.statistics[index].max) {
                values = metadata.statistics[index];
                return &metadata.schema.attributes[index];
            }
        }
    return nullptr;
}

void filter(Scene& scene, Table& table) {
    AttributeStatistics values;
    const Attribute* attribute = filteredAttribute(scene.cloud.metadata(), values);
    if (!attribute) {
        std::fprintf(stderr,
                     "skip_table: no attribute of the cloud has several values, so none is filtered\n");
        return;
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    auto meaning = [&](double stored) { return attribute->offset + attribute->scale * stored; };
    Style style;
    style.filters = {{attribute->name, meaning(values.min + 0.9 * (values.max - values.min)), infinity}};
    scene.cloud.hideBy(style);
    std::vector<NodePart> parts = scene.large(), showing = parts;
    std::erase_if(showing, [&](const NodePart& part) { return scene.cloud.hidesAllOf(part.node); });
    Work all = scene.work(parts, style), some = scene.work(showing, style);
    some.bytes = all.bytes; // that they show nothing is known once they are here
    table.add("filter: nodes of which it hides all points (" + attribute->name + ", the uppermost tenth)",
              all, some, Promise::exact);

    style.filters[0].min = meaning(values.max) + std::abs(meaning(values.max) - meaning(values.min)) + 1;
    scene.cloud.hideBy(style);
    all = scene.work(parts, style);
    bool hides = hidesAll(style, scene.cloud.metadata());
    some = scene.work(hides ? std::vector<NodePart>() : parts, style);
    table.add("filter: statistics say that it hides all points", all, some, Promise::exact);
}

void attributes(const Scene& scene, Table& table) {
    std::vector<NodePart> parts = scene.large();
    Work all = scene.work(parts, {}), some = scene.work(parts, {});
    all.bytes = 0;
    for (const NodePart& part : parts)
        all.bytes += static_cast<double>(scene.cloud.hierarchy().node(part.node).entry.sizeBytes());
    table.add("attribute: those that the style does not use", all, some, Promise::exact);
}

void pass(const Scene& scene, Table& table) {
    Style style;
    style.edl.strength = 1e-12; // changes nothing
    Work lit = scene.work(scene.large(), style);
    style.edl.strength = 0;
    Work plain = scene.work(scene.large(), style);
    table.add("pass: lighting that changes nothing", lit, plain, Promise::exact);
}

// Of a session, which selects, plans and draws a frame, or sees that there is nothing to do.
void frame(const std::string& path, const Camera& camera) {
    SettledViewer viewer(path, width, height);
    auto renderer = SoftwareRenderer::create(1);
    FramePlan plan = viewer.plan(camera, {}, noBudget, minNodePixels);
    double drawn = seconds([&] {
        viewer.session().setLimits(viewer.session().limits()); // makes it look again
        viewer.session().update();
        renderer->render(plan);
    });
    constexpr int stills = 1000;
    double still =
        seconds([&] {
            for (int i = 0; i < stills; ++i)
                if (viewer.session().update())
                    endBench({ErrorCode::invalidArgument, "a still camera made a new frame", path, ""});
        }) /
        stills;
    std::printf("| frame: nothing moved, nothing arrived | %zu → 0 | %.2f M → 0 | 0 → 0 | %.2g | 0, 0 |\n",
                plan.nodes.size(), static_cast<double>(plan.counters.pointsDrawn) / 1e6, still / drawn);
}

} // namespace

int main(int argc, char** argv) {
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
    if (argc < 2) {
        std::fprintf(stderr, "skip_table CLOUD.stipple [CAMERA-JSON]\n");
        return 2;
    }
    Scene scene{WholeCloud(argv[1], width, height), {}};
    BoxD bounds = scene.cloud.metadata().worldBounds();
    scene.camera.target = bounds.min + (bounds.max - bounds.min) * 0.5;
    scene.camera.position = scene.camera.target + Vec3d{-0.1, -0.15, 0.1} * length(bounds.max - bounds.min);
    if (argc > 2)
        scene.camera = need(cameraFromJson(std::string_view(argv[2]), scene.camera));
    Table table;
    frustum(scene, table);
    size(scene, table);
    prefix(scene, table);
    attributes(scene, table);
    pass(scene, table);
    clip(scene, table);
    filter(scene, table);
    frame(argv[1], scene.camera);
    return table.broken() ? 1 : 0;
}
