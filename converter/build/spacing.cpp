#include "converter/build/spacing.hpp"

#include "converter/build/parallel.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stipple {

namespace {
constexpr int densest = 16, thinnest = 2;
constexpr double maxScaleRatio = 100;
// Of the cells, one minimum distance wide, that points lie in, so many get a point: about 0.42 on surfaces
// (measured on airborne and indoor scans), 0.7 and more where points fill a volume.
constexpr double pointsPerCell = 0.6;
// How many points a node may take, before its parent takes a quarter of them, where the points are.
constexpr double targetSample = 75000;
constexpr std::size_t blockPoints = std::size_t{1} << 18;
constexpr std::size_t prefetchAhead = 24;

// For each point but the first: the lowest level at which an octree cell parts it from the one before it; 255
// for two points of one position.
Result<std::vector<std::uint8_t>> partingLevels(const Tiles& tiles, int threads,
                                                const std::atomic<bool>* stop) {
    std::vector<std::uint8_t> levels(tiles.order.size(), 0);
    std::size_t blocks = (levels.size() + blockPoints - 1) / blockPoints;
    STIPPLE_CHECK(parallelFor(blocks, threads, stop, [&](std::size_t block, int) -> Status {
        std::size_t begin = std::max<std::size_t>(1, block * blockPoints);
        std::size_t end = std::min(levels.size(), (block + 1) * blockPoints);
        Vec3i b = begin < end ? tiles.position(static_cast<std::uint32_t>(begin - 1)) - tiles.rootCube.min
                              : Vec3i{};
        for (std::size_t i = begin; i < end; ++i) {
            tiles.prefetch(static_cast<std::uint32_t>(std::min(i + prefetchAhead, end - 1)));
            Vec3i a = b;
            b = tiles.position(static_cast<std::uint32_t>(i)) - tiles.rootCube.min;
            auto difference = static_cast<std::uint64_t>((a.x ^ b.x) | (a.y ^ b.y) | (a.z ^ b.z));
            levels[i] = difference == 0
                            ? std::uint8_t{255}
                            : static_cast<std::uint8_t>(tiles.rootCube.bits - std::bit_width(difference) + 1);
        }
        return {};
    }));
    return levels;
}

// The octree cells d levels below a node that hold points, for d = 0, 1, …
using CellCounts = std::array<double, densest / 2 + 1>;

std::vector<CellCounts> cellsOfInnerNodes(const Tiles& tiles, const std::vector<std::uint8_t>& parting) {
    std::vector<CellCounts> result;
    for (const TileNode& node : tiles.nodes) {
        if (node.isLeaf || tiles.rootCube.nodeBits(node.key.level) > maxNodeBits)
            continue;
        std::array<std::uint32_t, 256> histogram{};
        for (std::uint32_t i = node.first + 1; i < node.end(); ++i)
            ++histogram[parting[i]];
        CellCounts counts{1};
        for (std::size_t below = 1; below < counts.size(); ++below)
            counts[below] = counts[below - 1] + static_cast<double>(histogram[node.key.level + below]);
        result.push_back(counts);
    }
    return result;
}

// The size of the node that a point is in, on average: large nodes count for what they hold.
double typicalSample(const std::vector<CellCounts>& nodes, int density) {
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
    std::vector<CellCounts> nodes = cellsOfInnerNodes(tiles, parting);
    while (spacing.density > thinnest && typicalSample(nodes, spacing.density) > targetSample)
        --spacing.density;
    return spacing;
}

} // namespace stipple
