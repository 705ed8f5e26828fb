// Time of a selection by known nodes: selection_bench [NODES...] (10^4, 10^5, 10^6). A camera low over a
// terrain flies ahead and turns a little each frame; medians over the frames, microseconds.
#include "client/core/camera.hpp"
#include "client/core/selection.hpp"
#include "tests/support/made_hierarchy.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

using namespace stipple;

namespace {

struct Way {
    const char* name;
    std::uint64_t pointBudget;
    double minNodePixels;
    double detailPixels;
};
constexpr Way ways[] = {
    {"2 M points, nodes of 60 px", 2'000'000, 60, 0},
    {"20 M points, nodes of 60 px", 20'000'000, 60, 0},
    {"20 M points, any size", 20'000'000, 0, 0},
    {"continuous, 2 M points", 2'000'000, 0, 0.5},
};

Camera cameraAt(double t, double side) {
    Camera camera;
    double angle = 0.7 + 0.3 * t;
    camera.position = {side * (0.3 + 0.2 * t), side * (0.35 + 0.1 * t), side * 0.004};
    camera.target = {camera.position.x + side * 0.02 * std::cos(angle),
                     camera.position.y + side * 0.02 * std::sin(angle), 0};
    return camera;
}

void measure(const Hierarchy& hierarchy, const Way& way) {
    using Clock = std::chrono::steady_clock;
    BoxD content = hierarchy.metadata().worldBounds();
    double side = content.max.x - content.min.x;
    std::vector<NodeResidency> residency(hierarchy.size());
    for (std::size_t i = 0; i < residency.size(); ++i)
        residency[i].points = hierarchy.node(i).entry.pointCount;
    std::vector<SelectionCloud> clouds{{&hierarchy, residency, 12}};
    SelectionInput input;
    input.height = 1080;
    input.clouds = clouds;
    input.pointBudget = way.pointBudget;
    input.byteBudget = 4ull << 30;
    input.minNodePixels = way.minNodePixels;
    input.detailPixels = way.detailPixels;
    std::vector<double> times;
    std::size_t chosen = 0;
    std::uint64_t visited = 0;
    constexpr int frames = 60;
    for (int frame = 0; frame < frames; ++frame) {
        // A thousandth of the way each frame.
        input.view = viewTransform(cameraAt(frame * 0.001, side), 1920, 1080, content);
        auto start = Clock::now();
        Selection selection = select(input);
        times.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
        chosen = selection.nodes.size();
        visited = selection.counters.nodesVisited + selection.counters.nodesOutsideFrustum +
                  selection.counters.nodesTooSmall + selection.counters.nodesOverBudget;
    }
    std::sort(times.begin(), times.end());
    std::printf("%10zu  %-28s %9.1f us   %zu selected, %llu looked at\n", hierarchy.size(), way.name,
                times[times.size() / 2], chosen, static_cast<unsigned long long>(visited));
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::size_t> sizes;
    for (int i = 1; i < argc; ++i)
        sizes.push_back(static_cast<std::size_t>(std::atoll(argv[i])));
    if (sizes.empty())
        sizes = {10'000, 100'000, 1'000'000};
    for (std::size_t size : sizes) {
        Hierarchy hierarchy = test::makeHierarchy({.nodes = size});
        for (const Way& way : ways)
            measure(hierarchy, way);
    }
}
