#include "tests/bench/sized_points.hpp"

#include "client/render/drawn_octree.hpp"

#include <algorithm>
#include <cmath>

namespace stipple {
namespace {

SizedPoint sizedPoint(const DrawNode& node, std::uint32_t i, double spacing) {
    const ResidentNode& points = *node.node;
    Vec3<std::uint32_t> p = positionOf(points, i);
    auto steps = [&](std::uint32_t corner, std::uint32_t in) {
        return (std::uint64_t{corner} << points.nodeBits) + in;
    };
    const std::vector<std::uint32_t>& colours = node.colourWords();
    return {node.cloud,
            colours.empty() ? plainColourWord : colours[i],
            steps(points.key.x, p.x),
            steps(points.key.y, p.y),
            steps(points.key.z, p.z),
            spacing};
}

} // namespace

std::vector<SizedPoint> sizedByWalk(const FramePlan& plan) {
    DrawnOctree tree = drawnOctree(plan);
    std::vector<SizedPoint> points;
    for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
        const DrawNode& node = plan.nodes[n];
        for (std::uint32_t i = 0; node.node && i < node.pointCount; ++i) {
            Vec3<std::uint32_t> p = positionOf(*node.node, i);
            int below = levelsBelow(tree.words.data(), tree.places[n], node.node->nodeBits, p.x, p.y, p.z);
            points.push_back(sizedPoint(node, i, std::ldexp(node.spacing, -below)));
        }
    }
    std::sort(points.begin(), points.end());
    return points;
}

std::vector<SizedPoint> sizedByBatches(const PointBatches& batches) {
    std::vector<SizedPoint> points;
    for (std::size_t n = 0; n < batches.plan().nodes.size(); ++n) {
        const DrawNode& node = batches.plan().nodes[n];
        for (const BatchRun& run : batches.runs(n))
            for (std::uint32_t i = run.first; i < run.first + run.count; ++i)
                points.push_back(sizedPoint(node, i, node.spacing));
    }
    std::sort(points.begin(), points.end());
    return points;
}

} // namespace stipple
