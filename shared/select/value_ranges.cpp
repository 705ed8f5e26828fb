#include "shared/select/value_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stipple {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool isFloating(const Attribute& attribute) {
    return attribute.type == AttributeType::f32 || attribute.type == AttributeType::f64;
}

double storedLimit(const Attribute& attribute, double limit, bool isLower) {
    if (std::isinf(limit))
        return attribute.scale < 0 ? -limit : limit;
    double steps = (limit - attribute.offset) / attribute.scale;
    if (isFloating(attribute))
        return steps;
    double rounding = 0x1p-50 * (std::abs(limit) + std::abs(attribute.offset)) / std::abs(attribute.scale);
    double nearest = std::nearbyint(steps);
    if (std::abs(steps - nearest) <= std::min(0.5, std::max(1e-9, rounding)))
        return nearest;
    return isLower == (attribute.scale > 0) ? std::ceil(steps) : std::floor(steps);
}

// What is left of a range without one value.
void addWithout(std::vector<ValueRange>& to, ValueRange range, double value, bool floating) {
    if (value < range.min || value > range.max) {
        to.push_back(range);
        return;
    }
    double before = floating ? std::nextafter(value, -infinity) : value - 1;
    double after = floating ? std::nextafter(value, infinity) : value + 1;
    if (range.min <= before)
        to.push_back({range.min, before});
    if (after <= range.max)
        to.push_back({after, range.max});
}

} // namespace

std::vector<ValueRange> storedRanges(const Attribute& attribute, const std::vector<ValueRange>& ranges) {
    std::vector<ValueRange> stored;
    bool isScaled = attribute.scale != 1 || attribute.offset != 0;
    for (ValueRange range : ranges) {
        if (isScaled) {
            range = {storedLimit(attribute, range.min, true), storedLimit(attribute, range.max, false)};
            if (attribute.scale < 0)
                std::swap(range.min, range.max);
        }
        if (attribute.noData)
            addWithout(stored, range, *attribute.noData, isFloating(attribute));
        else
            stored.push_back(range);
    }
    return stored;
}

} // namespace stipple
