#include "client/core/colour_style.hpp"

#include "shared/points/attribute.hpp"

#include <algorithm>

namespace stipple {

std::string_view attributeOf(ColourMode mode, const std::string& attribute) {
    switch (mode) {
    case ColourMode::intensity:
        return attribute_names::intensity;
    case ColourMode::classification:
        return attribute_names::classification;
    case ColourMode::returnNumber:
        return attribute_names::returnNumber;
    case ColourMode::numberOfReturns:
        return attribute_names::numberOfReturns;
    case ColourMode::pointSourceId:
        return attribute_names::pointSourceId;
    case ColourMode::gpsTime:
        return attribute_names::gpsTime;
    case ColourMode::attribute:
        return attribute;
    case ColourMode::rgb:
    case ColourMode::elevation:
    case ColourMode::level:
    case ColourMode::mix:
        break;
    }
    return {};
}

bool hidesPoints(const ColourStyle& style) {
    auto hides = [](const auto& clip) { return clip.mode != ClipMode::highlight; };
    return style.hiddenClasses.any() || !style.filters.empty() ||
           std::any_of(style.clipBoxes.begin(), style.clipBoxes.end(), hides) ||
           std::any_of(style.clipRegions.begin(), style.clipRegions.end(), hides);
}

} // namespace stipple
