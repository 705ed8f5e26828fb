// What each skip saves and what it costs in error, for one cloud and view: skip_table CLOUD.stipple
// [CAMERA-JSON]. Prints a Markdown table. Errors are against the same picture without the skip, levels of
// 255.
#include "client/core/continuous_detail.hpp"
#include "client/core/frustum.hpp"
#include "client/core/hierarchy.hpp"
#include "client/core/json.hpp"
#include "client/core/selection.hpp"
#include "client/core/view_session.hpp"
#include "client/headless/session_loader.hpp"
#include "client/headless/thread_decoder.hpp"
#include "client/measure/pixel_error.hpp"
#include "client/render/software_renderer.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/file_source.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

using namespace stipple;

namespace {

constexpr int width = 1920, height = 1080;

template <class T>
T need(Result<T> result) {
    if (!result.ok()) {
        std::fprintf(stderr, "skip_table: %s\n", result.error().sentence().c_str());
        std::exit(1);
    }
    return std::move(*result);
}

void row(const char* skip, const char* work, double without, double with, const char* error) {
    std::printf("| %s | %s: %.4g → %.4g | %.1f %% | %s |\n", skip, work, without, with,
                100 * (1 - with / std::max(without, 1e-300)), error);
}

std::string levels(const Image& a, const Image& b) {
    measure::PixelError apart = measure::pixelError(a, b, 0);
    char text[80];
    std::snprintf(text, sizeof text, "%.3f in the mean, %zu pixels", apart.mean, apart.differing);
    return apart.differing == 0 ? "none" : text;
}

struct Cloud {
    std::unique_ptr<ByteSource> source;
    std::unique_ptr<CloudReader> reader;
    Hierarchy hierarchy;
    std::uint64_t attributeBytes = 0, pictureBytes = 0;

    explicit Cloud(const std::string& path)
        : source(need(openFileSource(path))), reader(need(CloudReader::open(*source))) {
        std::vector<NodeEntry> nodes;
        Status read = reader->visitNodes([&](const NodeEntry& entry) {
            nodes.push_back(entry);
            nodes.back().childChunk = {};
            return Status();
        });
        if (!read.ok())
            std::exit(1);
        // A hierarchy wants parents first.
        std::stable_sort(nodes.begin(), nodes.end(),
                         [](const NodeEntry& a, const NodeEntry& b) { return a.key.level < b.key.level; });
        hierarchy =
            need(Hierarchy::create(std::make_shared<CloudMetadata>(reader->metadata()), std::move(nodes)));
    }
};

// A session over the cloud, settled before each look at it.
struct Viewer {
    std::unique_ptr<NodeDecoder> decoder = makeThreadDecoder(2);
    std::unique_ptr<ViewSession> session;
    std::unique_ptr<SoftwareRenderer> renderer = SoftwareRenderer::create(2);

    Viewer(const std::string& path, const Camera& camera) {
        SessionLimits limits;
        limits.pointBudget = 0;
        limits.cacheBytes = 4ull << 30;
        session = ViewSession::create(*decoder, limits);
        session->setViewport(width, height);
        session->addCloud(need(openFileSource(path)), path);
        settle([&] { return session->clouds()[0].stage == CloudStage::ready; });
        session->setCamera(camera);
    }
    void settle(const std::function<bool()>& done) {
        headless::SessionLoader loader(*session, "cloud", std::chrono::minutes(5));
        Status status = loader.until(done);
        if (!status.ok()) {
            std::fprintf(stderr, "skip_table: %s\n", status.error().sentence().c_str());
            std::exit(1);
        }
    }
    FramePlan plan(const Style& style, double minNodePixels) {
        SessionLimits limits = session->limits();
        limits.pointBudget = 1ull << 40;
        limits.minNodePixels = minNodePixels;
        session->setLimits(limits);
        session->setStyle(style);
        session->update();
        settle([&] { return session->settled(); });
        return session->plan();
    }
    Image picture(FramePlan plan) { return renderer->render(plan); }
    double drawSeconds(FramePlan plan) {
        std::vector<double> times;
        for (int i = 0; i < 9; ++i) {
            auto start = std::chrono::steady_clock::now();
            renderer->render(plan);
            times.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        }
        std::nth_element(times.begin(), times.begin() + 4, times.end());
        return times[4];
    }
};

double pointsAnywhere(const Hierarchy& hierarchy, const ViewTransform& view, double minNodePixels) {
    double points = 0;
    for (std::size_t i = 0; i < hierarchy.size(); ++i) {
        const HierarchyNode& node = hierarchy.node(i);
        if (i == 0 ||
            projectedPixels(view, height, node.geometry.centre, node.geometry.radius) >= minNodePixels)
            points += node.entry.pointCount;
    }
    return points;
}

void frustum(const Cloud& cloud, const Camera& camera, double minNodePixels) {
    std::vector<NodeResidency> residency(cloud.hierarchy.size());
    std::vector<SelectionCloud> clouds{{&cloud.hierarchy, residency, 12}};
    SelectionInput input;
    input.view = viewTransform(camera, width, height, cloud.hierarchy.metadata().worldBounds());
    input.height = height;
    input.clouds = clouds;
    input.pointBudget = input.byteBudget = ~0ull >> 8;
    input.minNodePixels = minNodePixels;
    Selection selection = select(input);
    row("frustum", "points", pointsAnywhere(cloud.hierarchy, input.view, minNodePixels),
        static_cast<double>(selection.counters.pointsSelected),
        "none: what is skipped is out of the picture");
}

void size(Viewer& viewer) {
    FramePlan all = viewer.plan({}, 0), large = viewer.plan({}, 60);
    row("size: nodes under 60 pixels", "points", static_cast<double>(all.counters.pointsDrawn),
        static_cast<double>(large.counters.pointsDrawn),
        levels(viewer.picture(all), viewer.picture(large)).c_str());
}

void prefix(Viewer& viewer) {
    Style style;
    style.detail.mode = DetailMode::continuous;
    style.detail.spacingPixels = 1;
    FramePlan sent = viewer.plan(style, 0);
    // Whatever else of these nodes is here lies behind the prefix.
    FramePlan whole = sent;
    double selected = 0;
    for (DrawNode& node : whole.nodes) {
        node.pointCount = node.node->pointCount;
        selected += node.node->totalPoints;
    }
    row("prefix: continuous detail, 1 pixel", "points", selected,
        static_cast<double>(sent.counters.pointsDrawn),
        levels(viewer.picture(whole), viewer.picture(sent)).c_str());
}

void attributes(const Cloud& cloud, Viewer& viewer) {
    FramePlan plan = viewer.plan({}, 60);
    double all = 0, used = 0;
    for (const DrawNode& node : plan.nodes) {
        const NodeEntry& entry =
            cloud.hierarchy.node(static_cast<std::size_t>(cloud.hierarchy.find(node.node->key))).entry;
        all += static_cast<double>(entry.sizeBytes());
        used += static_cast<double>(entry.strataRange(strataCount).size);
    }
    row("attributes that the style does not use", "bytes", all, used, "none");
}

void pass(Viewer& viewer) {
    Style style;
    FramePlan lit = viewer.plan(style, 60);
    style.edl.enabled = false;
    FramePlan plain = viewer.plan(style, 60);
    row("pass: eye-dome lighting off", "ms a frame", 1e3 * viewer.drawSeconds(lit),
        1e3 * viewer.drawSeconds(plain), "what was asked for");
}

void frame(Viewer& viewer) {
    FramePlan plan = viewer.plan({}, 60);
    double drawn = viewer.drawSeconds(plan);
    auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 1000; ++i)
        if (viewer.session->update())
            std::exit(1);
    double still = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / 1000;
    row("frame: nothing moved, nothing arrived", "ms a frame", 1e3 * drawn, 1e3 * still, "none");
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fprintf(stderr, "skip_table CLOUD.stipple [CAMERA-JSON]\n");
        return 2;
    }
    Cloud cloud(argv[1]);
    BoxD bounds = cloud.hierarchy.metadata().worldBounds();
    Camera camera;
    camera.target = bounds.min + (bounds.max - bounds.min) * 0.5;
    camera.position = camera.target + Vec3d{-0.1, -0.15, 0.1} * length(bounds.max - bounds.min);
    if (argc > 2)
        camera = need(cameraFromJson(std::string_view(argv[2]), camera));
    Viewer viewer(argv[1], camera);
    std::printf("| skip | work | saved | error |\n|---|---|---|---|\n");
    frustum(cloud, camera, 60);
    size(viewer);
    prefix(viewer);
    attributes(cloud, viewer);
    pass(viewer);
    frame(viewer);
}
