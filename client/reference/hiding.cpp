// Which points a style hides or tints, in arithmetic of its own: long double, from the definitions in
// client/core/colour_style.hpp.
#include "client/reference/marks.hpp"
#include "client/reference/shape.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::reference {
namespace {

bool isInAny(const Style& style, ClipMode mode, const Vec3l& world) {
    auto holds = [&](const ClipBox& box) {
        return box.mode == mode && isInBox({box.centre, box.halfSize, box.axes}, world);
    };
    auto holdsRegion = [&](const ClipRegion& clip) {
        return clip.mode == mode && isInShape(clip.shape, world);
    };
    return std::any_of(style.clipBoxes.begin(), style.clipBoxes.end(), holds) ||
           std::any_of(style.clipRegions.begin(), style.clipRegions.end(), holdsRegion);
}

bool hasAny(const Style& style, ClipMode mode) {
    auto isOf = [&](const auto& clip) { return clip.mode == mode; };
    return std::any_of(style.clipBoxes.begin(), style.clipBoxes.end(), isOf) ||
           std::any_of(style.clipRegions.begin(), style.clipRegions.end(), isOf);
}

bool isWithin(const AttributeFilter& filter, const Attribute& attribute, double value) {
    // A millionth of a step: what rounding may move the meaning of a scaled integer by, and more.
    bool scaled = attribute.scale != 1 || attribute.offset != 0;
    double slack = scaled ? std::abs(attribute.scale) * 1e-6 : 0;
    return value >= filter.min - slack && value <= filter.max + slack;
}

} // namespace

std::vector<bool> shownOf(const Style& style, const Points& points) {
    std::vector<bool> shown(points.batch->size(), true);
    int classes = style.hiddenClasses.any() ? columnOf(points, attribute_names::classification) : -1;
    bool showsSome = hasAny(style, ClipMode::hideOutside), hidesSome = hasAny(style, ClipMode::hideInside);
    for (std::size_t i = 0; i < shown.size(); ++i) {
        if (classes >= 0 && style.hiddenClasses[static_cast<std::uint8_t>(meaningOf(points, classes, i))])
            shown[i] = false;
        for (const AttributeFilter& filter : style.filters) {
            int column = columnOf(points, filter.attribute);
            if (column >= 0 && !isWithin(filter, points.attributes[static_cast<std::size_t>(column)],
                                         meaningOf(points, column, i)))
                shown[i] = false;
        }
        if ((showsSome && !isInAny(style, ClipMode::hideOutside, worldOf(points, i))) ||
            (hidesSome && isInAny(style, ClipMode::hideInside, worldOf(points, i))))
            shown[i] = false;
    }
    return shown;
}

void highlight(const Style& style, const Points& points, std::vector<Colour>& colours) {
    if (!hasAny(style, ClipMode::highlight))
        return;
    for (std::size_t i = 0; i < colours.size(); ++i)
        if (isInAny(style, ClipMode::highlight, worldOf(points, i)))
            for (std::size_t c = 0; c < 3; ++c)
                colours[i][c] = (colours[i][c] + static_cast<float>(style.highlight[c])) / 2;
}

} // namespace stipple::reference
