// What changes in a picture because points come and go, not because the camera moves: popping [FRAMES]
// CLOUD... On a slow way towards the middle (0.3 % nearer each frame) the points that one frame shows are
// drawn with the next frame's camera and compared with what that frame shows. Continuous detail against
// levels with as many points, single sizes (no growing, which would soften it further). Of blocks of 16 × 16
// pixels: mean level of change and root mean square, over all of them of all frames; the largest block of a
// frame, averaged over the frames; the change that one block in 1,000, and in 10,000, exceeds; and the worst.
//
// The mean says how much changes on the whole, which the way decides more than how it is spread: what comes
// and goes between the first picture and the last is as much in small steps as in large ones. Popping is that
// much of it comes at once, in one place: the other figures.
#include "client/core/continuous_detail.hpp"
#include "client/core/frame_planner.hpp"
#include "client/render/software_renderer.hpp"
#include "tests/bench/settled_viewer.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>

using namespace stipple;

namespace {

constexpr int width = 1280, height = 720, blockPixels = 16;
constexpr double step = 0.997, spacingPixels = 2;

Camera cameraAt(const CloudMetadata& metadata, int frame) {
    BoxD bounds = metadata.worldBounds();
    Camera camera;
    camera.target = bounds.min + (bounds.max - bounds.min) * 0.5;
    camera.position =
        camera.target + Vec3d{-0.12, -0.18, 0.1} * length(bounds.max - bounds.min) * std::pow(step, frame);
    return camera;
}

bool shows(const FramePlan& plan, const DrawNode& node, std::uint32_t rank, Vec3d world) {
    if (plan.detailPixels == 0)
        return true;
    double distance = dot(world - plan.view.eye, plan.view.forward);
    double target = plan.detailPixels * pixelWorld(plan.view, plan.height, distance);
    return (node.density.base + node.density.step * rank) * target * target < 1;
}

// The plan with only the points that it shows, whole, as seen from another view.
FramePlan frozen(const CloudMetadata& metadata, const FramePlan& plan, const ViewTransform& view,
                 std::uint64_t& points) {
    FramePlan result;
    result.width = plan.width;
    result.height = plan.height;
    result.view = view;
    result.style = plan.style;
    result.style.detail.mode = DetailMode::discrete;
    for (const DrawNode& node : plan.nodes) {
        auto kept = std::make_shared<ResidentNode>();
        kept->id = nextResidentNodeId();
        kept->key = node.node->key;
        kept->nodeBits = node.node->nodeBits;
        kept->positionShift = node.node->positionShift;
        Vec3i corner = metadata.rootCube.nodeMin(kept->key);
        for (std::uint32_t i = 0; i < node.pointCount; ++i) {
            Vec3<std::uint32_t> p = positionOf(*node.node, i);
            Vec3d world = metadata.grid.toWorld({corner.x + p.x, corner.y + p.y, corner.z + p.z});
            if (!shows(plan, node, i, world))
                continue;
            kept->positionWords.push_back(node.node->positionWords[2 * i]);
            kept->positionWords.push_back(node.node->positionWords[2 * i + 1]);
            if (kept->positionShift > 0)
                kept->positionLowWords.push_back(node.node->positionLowWords[i]);
            if (!node.node->colourWords.empty())
                kept->colourWords.push_back(node.node->colourWords[i]);
        }
        kept->pointCount = kept->totalPoints = static_cast<std::uint32_t>(kept->positionWords.size() / 2);
        points += kept->pointCount;
        if (kept->pointCount > 0)
            result.nodes.push_back(planNode(kept, kept->pointCount, metadata, view.eye));
    }
    return result;
}

// Over blocks: mean difference of levels.
std::vector<double> changeOf(const Image& a, const Image& b) {
    std::vector<double> levels;
    for (int top = 0; top + blockPixels <= height; top += blockPixels)
        for (int left = 0; left + blockPixels <= width; left += blockPixels) {
            double sum = 0;
            for (int y = top; y < top + blockPixels; ++y)
                for (int x = left; x < left + blockPixels; ++x)
                    for (int c = 0; c < 3; ++c) {
                        auto at = static_cast<std::size_t>(4 * (y * width + x) + c);
                        sum += std::abs(int{a.rgba[at]} - int{b.rgba[at]});
                    }
            levels.push_back(sum / (3.0 * blockPixels * blockPixels));
        }
    return levels;
}

struct Outcome {
    double points = 0, largest = 0; // means over the frames
    std::vector<double> blocks;     // of all frames

    double mean() const { return std::accumulate(blocks.begin(), blocks.end(), 0.0) / size(); }
    double rms() const {
        return std::sqrt(std::inner_product(blocks.begin(), blocks.end(), blocks.begin(), 0.0) / size());
    }
    // What a part of the blocks exceeds; sorts them.
    double exceededBy(double part) {
        std::sort(blocks.begin(), blocks.end());
        return blocks[static_cast<std::size_t>((size() - 1) * (1 - part))];
    }

  private:
    double size() const { return static_cast<double>(blocks.size()); }
};

// Along the path. `budgets`: of each frame; empty: no limit.
Outcome along(SettledViewer& viewer, const Style& style, int frames, std::vector<std::uint64_t>& counts,
              bool follow) {
    auto renderer = SoftwareRenderer::create(2);
    const CloudMetadata& metadata = viewer.metadata();
    Outcome result;
    FramePlan before;
    for (int frame = 0; frame <= frames; ++frame) {
        auto at = static_cast<std::size_t>(frame);
        FramePlan plan = viewer.plan(cameraAt(metadata, frame), style, follow ? counts[at] : noBudget, 0);
        std::uint64_t points = 0, earlier = 0;
        FramePlan now = frozen(metadata, plan, plan.view, points);
        if (!follow)
            counts.push_back(points);
        result.points += static_cast<double>(points) / (frames + 1);
        if (frame > 0) {
            FramePlan old = frozen(metadata, before, plan.view, earlier);
            Image a = renderer->render(old);
            std::vector<double> blocks = changeOf(a, renderer->render(now));
            result.largest += *std::max_element(blocks.begin(), blocks.end()) / frames;
            result.blocks.insert(result.blocks.end(), blocks.begin(), blocks.end());
        }
        before = std::move(plan);
    }
    return result;
}

void show(const char* cloud, const char* mode, Outcome r) {
    std::printf("| %s | %s | %.2f M | %.3f | %.3f | %.2f | %.2f | %.2f | %.2f |\n", cloud, mode,
                r.points / 1e6, r.mean(), r.rms(), r.largest, r.exceededBy(1e-3), r.exceededBy(1e-4),
                r.exceededBy(0));
}

} // namespace

int main(int argc, char** argv) {
    int frames = argc > 1 ? std::atoi(argv[1]) : 0;
    if (argc < 3 || frames < 1) {
        std::fprintf(stderr, "popping FRAMES CLOUD.stipple...\n");
        return 2;
    }
    std::printf(
        "| cloud | | points | mean | RMS | largest block of a frame | one in 1,000 | one in 10,000 | worst "
        "|\n|---|---|---|---|---|---|---|---|---|\n");
    for (int i = 2; i < argc; ++i) {
        SettledViewer viewer(argv[i], width, height);
        std::vector<std::uint64_t> counts;
        Style style;
        style.detail.mode = DetailMode::continuous;
        style.detail.spacingPixels = spacingPixels;
        style.edl.enabled = false;
        show(argv[i], "continuous", along(viewer, style, frames, counts, false));
        style.detail.mode = DetailMode::discrete;
        show(argv[i], "levels", along(viewer, style, frames, counts, true));
    }
}
