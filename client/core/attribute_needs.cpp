#include "client/core/attribute_needs.hpp"

#include "client/core/node_columns.hpp"
#include "client/core/node_normals.hpp"
#include "client/core/node_paint.hpp"
#include "shared/base/text.hpp"
#include "shared/format/cloud_file.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace stipple {

namespace {

// Those that the colours and filters of the style look at; -1 among them: one that the cloud lacks.
std::set<int> attributesOf(const ColourStyle& style, const Schema& schema) {
    std::set<int> attributes;
    auto add = [&](std::string_view name) {
        if (!name.empty())
            attributes.insert(findAttribute(schema, name));
    };
    add(attributeOf(style.colourMode, style.attribute));
    if (style.colourMode == ColourMode::mix)
        for (const MixedColour& one : style.mix)
            add(attributeOf(one.mode, one.attribute));
    if (style.hiddenClasses.any())
        add(attribute_names::classification);
    for (const AttributeFilter& filter : style.filters)
        add(filter.attribute);
    attributes.erase(-1);
    return attributes;
}

bool showsRgb(const ColourStyle& style) {
    return style.colourMode == ColourMode::rgb ||
           (style.colourMode == ColourMode::mix &&
            std::any_of(style.mix.begin(), style.mix.end(),
                        [](const MixedColour& one) { return one.mode == ColourMode::rgb; }));
}

bool contains(const std::vector<int>& list, int value) {
    return std::find(list.begin(), list.end(), value) != list.end();
}

AttributeNeeds needsOf(const ColourStyle& style, const std::set<int>& attributes,
                       const CloudMetadata& metadata) {
    AttributeNeeds needs;
    std::vector<AttributeBlock> blocks = attributeBlocks(metadata);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        bool looksAt = std::any_of(attributes.begin(), attributes.end(),
                                   [&](int attribute) { return contains(blocks[b].attributes, attribute); });
        if (blocks[b].isExactColour) {
            if (looksAt || (showsRgb(style) && metadata.pictureColour == PictureColour::rgb))
                needs.exactBlock = static_cast<int>(b);
        } else if (looksAt) {
            needs.blocks.push_back(static_cast<int>(b));
        }
    }
    return needs;
}

} // namespace

AttributeNeeds needsOf(const ColourStyle& style, const CloudMetadata& metadata) {
    return needsOf(style, attributesOf(style, metadata.schema), metadata);
}

AttributeNeeds needsOf(const Style& style, const CloudMetadata& metadata) {
    std::set<int> attributes = attributesOf(style, metadata.schema);
    if (style.shape == PointShape::disc)
        if (auto normals = normalAttributes(metadata.schema))
            attributes.insert(normals->begin(), normals->end());
    return needsOf(style, attributes, metadata);
}

AttributeNeeds needsOfAll(const ColourStyle& style, const CloudMetadata& metadata) {
    AttributeNeeds needs = needsOf(style, metadata);
    std::vector<AttributeBlock> blocks = attributeBlocks(metadata);
    needs.blocks.clear();
    for (std::size_t b = 0; b < blocks.size(); ++b)
        if (!blocks[b].isExactColour)
            needs.blocks.push_back(static_cast<int>(b));
    return needs;
}

bool hidesAll(const ColourStyle& style, const CloudMetadata& metadata) {
    auto statisticsOf = [&](int attribute) -> const AttributeStatistics* {
        auto at = static_cast<std::size_t>(attribute);
        return attribute >= 0 && at < metadata.statistics.size() ? &metadata.statistics[at] : nullptr;
    };
    int classification = findAttribute(metadata.schema, attribute_names::classification);
    if (const AttributeStatistics* classes = statisticsOf(classification);
        classes && style.hiddenClasses.any() && !classes->histogram.empty()) {
        bool all = std::all_of(classes->histogram.begin(), classes->histogram.end(), [&](const auto& entry) {
            auto [value, points] = entry;
            return points == 0 ||
                   (value >= 0 && value <= 255 && style.hiddenClasses[static_cast<std::size_t>(value)]);
        });
        if (all)
            return true;
    }
    return std::any_of(style.filters.begin(), style.filters.end(), [&](const AttributeFilter& filter) {
        int attribute = findAttribute(metadata.schema, filter.attribute);
        const AttributeStatistics* values = statisticsOf(attribute);
        if (!values)
            return false;
        const Attribute& known = metadata.schema.attributes[static_cast<std::size_t>(attribute)];
        double a = known.offset + known.scale * values->min, b = known.offset + known.scale * values->max;
        double slack = 2e-6 * std::abs(known.scale);
        return filter.max < std::min(a, b) - slack || filter.min > std::max(a, b) + slack;
    });
}

Phrase lackOf(const Style& style, const CloudMetadata& metadata, std::string_view cloudName) {
    if (style.shape != PointShape::disc)
        return {};
    bool singlePixels =
        style.sizeMode == PointSizeMode::fixed && std::max(style.sizePixels, style.minSizePixels) <= 1;
    if (normalAttributes(metadata.schema))
        return singlePixels
                   ? say("points of a single pixel have no shape: discs show from a sizePixels above 1 on")
                   : Phrase();
    return say(cloudName,
               " has no normals (attributes NormalX, NormalY, NormalZ, or nx, ny, nz): its points are "
               "drawn as circles, not as discs");
}

std::uint32_t columnBytes(const AttributeNeeds& needs, const CloudMetadata& metadata) {
    std::vector<AttributeBlock> blocks = attributeBlocks(metadata);
    std::size_t bytes = 0;
    for (int block : needs.blocks)
        for (int attribute : blocks[static_cast<std::size_t>(block)].attributes)
            bytes += metadata.schema.attributes[static_cast<std::size_t>(attribute)].size();
    return static_cast<std::uint32_t>(bytes);
}

} // namespace stipple
