#include "converter/build/spacing.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stipple {

namespace {
constexpr int thinnest = 2;
// Of the cells, one minimum distance wide, that points lie in, so many get a point. Poisson: about 0.42 on
// surfaces (measured on airborne and indoor scans), 0.7 and more where points fill a volume.
double pointsPerCell(Sampling sampling) {
    return sampling == Sampling::poisson ? 0.6 : 1;
}
// How many points a node may take, before its parent takes a quarter of them, where the points are.
constexpr double targetSample = 75000;

// For each point but the first: the lowest level at which an octree cell parts it from the one before it; 255
// for two points of one position.
std::vector<std::uint8_t> partingLevels(const Subtree& subtree) {
    std::vector<std::uint8_t> levels(subtree.size(), 0);
    const RootCube& cube = subtree.cube();
    Vec3i b = subtree.size() > 0 ? subtree.position(0) - cube.min : Vec3i{};
    for (std::uint32_t i = 1; i < subtree.size(); ++i) {
        Vec3i a = b;
        b = subtree.position(i) - cube.min;
        auto difference = static_cast<std::uint64_t>((a.x ^ b.x) | (a.y ^ b.y) | (a.z ^ b.z));
        levels[i] = difference == 0 ? std::uint8_t{255}
                                    : static_cast<std::uint8_t>(cube.bits - std::bit_width(difference) + 1);
    }
    return levels;
}

using CellCounts = SpacingEstimate::CellCounts;

void addCellsOfInnerNodes(const Subtree& subtree, std::vector<CellCounts>& result) {
    std::vector<std::uint8_t> parting = partingLevels(subtree);
    for (const SubtreeNode& node : subtree.nodes()) {
        if (node.isLeaf || subtree.cube().nodeBits(node.key.level) > maxNodeBits)
            continue;
        std::array<std::uint32_t, 256> histogram{};
        for (std::uint32_t i = node.first + 1; i < node.end(); ++i)
            ++histogram[parting[i]];
        CellCounts counts{1};
        for (std::size_t below = 1; below < counts.size(); ++below)
            counts[below] = counts[below - 1] + static_cast<double>(histogram[node.key.level + below]);
        result.push_back(counts);
    }
}

// The size of the node that a point is in, on average: large nodes count for what they hold.
double typicalSample(const std::vector<CellCounts>& nodes, int density, double pointsPerCell) {
    auto finer = static_cast<std::size_t>((density + 1) / 2), coarser = static_cast<std::size_t>(density / 2);
    double sum = 0, squares = 0;
    for (const CellCounts& cells : nodes) {
        double points = pointsPerCell * std::sqrt(cells[finer] * cells[coarser]);
        sum += points;
        squares += points * points;
    }
    return sum > 0 ? squares / sum : 0;
}
} // namespace

double Spacing::squaredSteps(int nodeBits) const {
    return std::ldexp(1.0, 2 * nodeBits - density);
}

double Spacing::world(int nodeBits) const {
    // One unit in the last place less, for the rounding of the root and the product.
    return std::nextafter(std::sqrt(squaredSteps(nodeBits)) * metric.unit, 0.0);
}

SpacingEstimate::SpacingEstimate(const DistanceMetric& metric) : metric_(metric) {}

void SpacingEstimate::add(const Subtree& subtree) {
    addCellsOfInnerNodes(subtree, nodes_);
}

void SpacingEstimate::add(const SpacingEstimate& other) {
    nodes_.insert(nodes_.end(), other.nodes_.begin(), other.nodes_.end());
}

Spacing SpacingEstimate::choose(Sampling sampling) const {
    Spacing spacing;
    spacing.metric = metric_;
    while (spacing.density > thinnest &&
           typicalSample(nodes_, spacing.density, pointsPerCell(sampling)) > targetSample)
        --spacing.density;
    return spacing;
}

} // namespace stipple
