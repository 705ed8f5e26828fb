#include "client/core/frame_planner.hpp"

#include "client/core/node_columns.hpp"

#include <algorithm>
#include <cmath>

namespace stipple {

namespace {

constexpr double farthestCell = 0x1p61;

struct Difference {
    double value, error; // a - b == value + error, exactly
};
// Two-sum (Knuth, TAOCP vol. 2, 4.2.2).
Difference exactDifference(double a, double b) {
    double value = a - b;
    double bPart = a - value;
    double aPart = value + bPart;
    return {value, (a - aPart) - (b - bPart)};
}

// Mean and deviation of several groups taken together.
struct Pool {
    double count = 0, sum = 0, squares = 0, min = HUGE_VAL, max = -HUGE_VAL;
    void add(double points, const AttributeStatistics& s) {
        count += points;
        sum += points * s.mean;
        squares += points * (s.deviation * s.deviation + s.mean * s.mean);
        min = std::min(min, s.min);
        max = std::max(max, s.max);
    }
    Range typical() const {
        double mean = sum / count;
        double deviation = std::sqrt(std::max(0.0, squares / count - mean * mean));
        return {std::max(min, mean - 2 * deviation), std::min(max, mean + 2 * deviation)};
    }
};

Range usable(Range range) {
    if (!(std::isfinite(range.min) && std::isfinite(range.max)))
        range = {0, 1};
    // Wide enough to be two different floats.
    double least = std::max(1e-6, 1e-6 * std::max(std::abs(range.min), std::abs(range.max)));
    if (range.max - range.min < least)
        range.max = range.min + std::max(1.0, least);
    return range;
}

} // namespace

GridPosition gridPosition(double world, double offset, double scale) {
    Difference steps = exactDifference(world, offset);
    double cell = std::floor(steps.value / scale);
    if (!(std::abs(cell) < farthestCell))
        return {static_cast<std::int64_t>(std::copysign(farthestCell, steps.value)), 0};
    // fma: the remainder is exact although the quotient was rounded.
    double fraction = (std::fma(-cell, scale, steps.value) + steps.error) / scale;
    double carry = std::floor(fraction);
    fraction -= carry;
    if (fraction >= 1) // a tiny negative remainder, rounded up
        fraction = std::nextafter(1.0, 0.0);
    return {static_cast<std::int64_t>(cell) + static_cast<std::int64_t>(carry), fraction};
}

DrawNode planNode(std::shared_ptr<const ResidentNode> node, std::uint32_t pointCount,
                  const CloudMetadata& metadata, Vec3d eye) {
    const Grid& grid = metadata.grid;
    Vec3i corner = metadata.rootCube.nodeMin(node->key);
    std::int64_t last = std::min(std::int64_t{1} << node->nodeBits, std::int64_t{INT32_MAX});
    DrawNode draw;
    for (int axis = 0; axis < 3; ++axis) {
        auto i = static_cast<std::size_t>(axis);
        GridPosition at = gridPosition(eye[axis], grid.offset[axis], grid.scale[axis]);
        std::int64_t cell = at.cell - corner[axis];
        std::int64_t inside = std::clamp<std::int64_t>(cell, 0, last);
        draw.cameraCell[i] = static_cast<std::int32_t>(inside);
        draw.cameraOffset[i] = static_cast<double>(cell - inside) + at.fraction;
        draw.cameraFraction[i] = static_cast<float>(draw.cameraOffset[i]);
    }
    draw.pointCount = std::min(pointCount, node->pointCount);
    draw.scale = grid.scale;
    draw.spacing = std::ldexp(metadata.spacing, -node->key.level);
    draw.density = rankDensity(node->key.level, draw.spacing, node->totalPoints);
    draw.node = std::move(node);
    return draw;
}

// Of what the attribute means, over all its values.
Range wholeRange(std::string_view name, std::span<const std::shared_ptr<const CloudMetadata>> clouds) {
    Range whole{HUGE_VAL, -HUGE_VAL};
    for (const auto& metadata : clouds) {
        int found = findAttribute(metadata->schema, name);
        auto index = static_cast<std::size_t>(found);
        if (found < 0 || index >= metadata->statistics.size() || metadata->pointCount == 0)
            continue;
        const Attribute& attribute = metadata->schema.attributes[index];
        for (double stored : {metadata->statistics[index].min, metadata->statistics[index].max}) {
            double value = attribute.offset + attribute.scale * stored;
            whole = {std::min(whole.min, value), std::max(whole.max, value)};
        }
    }
    return whole;
}

// From the root's level to that at which points on a surface as large as the cloud are as near to each other
// as its points are.
Range levelsOf(std::span<const std::shared_ptr<const CloudMetadata>> clouds) {
    double deepest = 1;
    for (const auto& metadata : clouds) {
        BoxD box = metadata->worldBounds();
        if (box.empty() || metadata->pointCount == 0)
            continue;
        Vec3d size = box.max - box.min;
        double area = std::max({size.x * size.y, size.y * size.z, size.z * size.x});
        double apart = std::sqrt(area / static_cast<double>(metadata->pointCount));
        if (apart > 0 && metadata->spacing > 0)
            deepest = std::max(deepest, std::ceil(std::log2(metadata->spacing / apart)));
    }
    return {0, deepest};
}

Range resolvedRange(const Style& resolved, ColourMode mode, const std::string& attribute, Range range,
                    std::span<const std::shared_ptr<const CloudMetadata>> clouds) {
    if (range.min != range.max)
        return usable(range);
    switch (mode) {
    case ColourMode::intensity:
        return resolved.intensityRange;
    case ColourMode::elevation:
        return resolved.elevationRange;
    case ColourMode::level:
        return resolved.levelRange;
    default:
        return usable(wholeRange(attributeOf(mode, attribute), clouds));
    }
}

Style resolvedStyle(const Style& style, std::span<const std::shared_ptr<const CloudMetadata>> clouds) {
    Style resolved = style;
    Pool intensity;
    Range elevation{HUGE_VAL, -HUGE_VAL};
    for (const auto& metadata : clouds) {
        int found = findAttribute(metadata->schema, attribute_names::intensity);
        auto index = static_cast<std::size_t>(found);
        if (found >= 0 && index < metadata->statistics.size() && metadata->pointCount > 0)
            intensity.add(static_cast<double>(metadata->pointCount), metadata->statistics[index]);
        BoxD box = metadata->worldBounds();
        if (!box.empty())
            elevation = {std::min(elevation.min, box.min.z), std::max(elevation.max, box.max.z)};
    }
    if (style.intensityRange.min == style.intensityRange.max)
        resolved.intensityRange = intensity.count > 0 ? intensity.typical() : Range{0, 65535};
    if (style.elevationRange.min == style.elevationRange.max)
        resolved.elevationRange = elevation;
    if (style.levelRange.min == style.levelRange.max)
        resolved.levelRange = levelsOf(clouds);
    for (Range* range : {&resolved.intensityRange, &resolved.elevationRange, &resolved.levelRange})
        *range = usable(*range);
    if (!attributeOf(style.colourMode, style.attribute).empty())
        resolved.attributeRange =
            resolvedRange(resolved, style.colourMode, style.attribute, style.attributeRange, clouds);
    for (MixedColour& one : resolved.mix)
        one.range = resolvedRange(resolved, one.mode, one.attribute, one.range, clouds);
    return resolved;
}

} // namespace stipple
