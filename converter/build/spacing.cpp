#include "converter/build/spacing.hpp"

#include "converter/build/parallel.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stipple {

namespace {
constexpr int densest = 16, thinnest = 2;
constexpr double maxScaleRatio = 100;
// Of the cells, one minimum distance wide, that points lie in, this share gets a point (measured on airborne,
// terrestrial and indoor scans: 0.38 to 0.46).
constexpr double pointsPerCell = 0.42;
// What a node may hold on average before its parent takes a quarter of it.
constexpr double targetSample = 60000;
constexpr std::size_t blockPoints = std::size_t{1} << 18;

// For each point but the first: the lowest level at which an octree cell parts it from the one before it; 255
// for two points of one position.
Result<std::vector<std::uint8_t>> partingLevels(const Tiles& tiles, int threads,
                                                const std::atomic<bool>* stop) {
    std::vector<std::uint8_t> levels(tiles.order.size(), 0);
    std::size_t blocks = (levels.size() + blockPoints - 1) / blockPoints;
    STIPPLE_CHECK(parallelFor(blocks, threads, stop, [&](std::size_t block, int) -> Status {
        std::size_t begin = std::max<std::size_t>(1, block * blockPoints);
        std::size_t end = std::min(levels.size(), (block + 1) * blockPoints);
        for (std::size_t i = begin; i < end; ++i) {
            Vec3i a = tiles.position(static_cast<std::uint32_t>(i - 1)) - tiles.rootCube.min;
            Vec3i b = tiles.position(static_cast<std::uint32_t>(i)) - tiles.rootCube.min;
            auto difference = static_cast<std::uint64_t>((a.x ^ b.x) | (a.y ^ b.y) | (a.z ^ b.z));
            levels[i] = difference == 0
                            ? std::uint8_t{255}
                            : static_cast<std::uint8_t>(tiles.rootCube.bits - std::bit_width(difference) + 1);
        }
        return {};
    }));
    return levels;
}

// cells[d]: octree cells d levels below their node that hold points, summed over all inner nodes.
struct InnerCells {
    std::array<double, densest / 2 + 1> cells{};
    double nodes = 0;
};
InnerCells countInnerCells(const Tiles& tiles, const std::vector<std::uint8_t>& parting) {
    InnerCells sum;
    for (const TileNode& node : tiles.nodes) {
        if (node.isLeaf || tiles.rootCube.nodeBits(node.key.level) > maxNodeBits)
            continue;
        std::array<std::uint32_t, 256> histogram{};
        for (std::uint32_t i = node.first + 1; i < node.end(); ++i)
            ++histogram[parting[i]];
        double cells = 1;
        for (int below = 0; below <= densest / 2; ++below) {
            int level = node.key.level + below;
            cells += below == 0 ? 0 : static_cast<double>(histogram[static_cast<std::size_t>(level)]);
            sum.cells[static_cast<std::size_t>(below)] += cells;
        }
        sum.nodes += 1;
    }
    return sum;
}
} // namespace

DistanceMetric distanceMetric(const Grid& grid, const Crs& crs) {
    DistanceMetric metric;
    metric.unit = std::max(grid.scale.x, grid.scale.y);
    for (int axis = 0; axis < 3; ++axis)
        metric.weights[axis] = grid.scale[axis] / metric.unit;
    bool angular = crs.known() && crs.unitMeters == 0 && crs.unit.starts_with("deg");
    if (angular || metric.weights.z > maxScaleRatio || metric.weights.z < 1 / maxScaleRatio)
        metric.weights.z = 0;
    return metric;
}

double Spacing::squaredSteps(int nodeBits) const {
    return std::ldexp(1.0, 2 * nodeBits - density);
}

double Spacing::world(int nodeBits) const {
    // One unit in the last place less, for the rounding of the root and the product.
    return std::nextafter(std::sqrt(squaredSteps(nodeBits)) * metric.unit, 0.0);
}

Result<Spacing> chooseSpacing(const Tiles& tiles, const DistanceMetric& metric, int threads,
                              const std::atomic<bool>* stop) {
    Spacing spacing;
    spacing.metric = metric;
    STIPPLE_TRY(parting, partingLevels(tiles, threads, stop));
    InnerCells inner = countInnerCells(tiles, parting);
    for (spacing.density = densest; spacing.density > thinnest; --spacing.density) {
        auto finer = static_cast<std::size_t>((spacing.density + 1) / 2);
        auto coarser = static_cast<std::size_t>(spacing.density / 2);
        double cells = std::sqrt(inner.cells[finer] * inner.cells[coarser]);
        if (pointsPerCell * cells <= targetSample * inner.nodes)
            break;
    }
    return spacing;
}

} // namespace stipple
