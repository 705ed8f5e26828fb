#include "client/core/node_paint.hpp"

#include "client/core/frame_planner.hpp"
#include "client/core/gradients.hpp"
#include "shared/points/point_classes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stipple {

namespace {

constexpr std::uint32_t colourMask = 0x00FFFFFF;

std::uint32_t wordOf(const std::array<std::uint8_t, 3>& colour) {
    return colour[0] | std::uint32_t{colour[1]} << 8 | std::uint32_t{colour[2]} << 16 | 0xFF000000u;
}

ByteSpan findColumn(const PaintedNode& node, std::int32_t attribute) {
    for (const auto& columns : node.columns)
        if (ByteSpan found = columns->column(attribute); !found.empty())
            return found;
    return node.node->columns.column(attribute);
}

// 0, 1, 2 for the attributes that colour words are made of; else -1.
int channelOf(const Attribute& attribute) {
    const std::array<std::string_view, 3> names{attribute_names::red, attribute_names::green,
                                                attribute_names::blue};
    auto at = std::find(names.begin(), names.end(), attribute.name);
    return at == names.end() ? -1 : static_cast<int>(at - names.begin());
}

// Entries of the gradient for values `above` the start of a range of that width.
std::vector<std::uint32_t> alongGradient(const GradientTable& table, const std::vector<double>& above,
                                         double width) {
    constexpr double last = gradientEntries - 1;
    double scale = last / (width > 0 ? width : 1);
    std::vector<std::uint32_t> words(above.size());
    for (std::size_t i = 0; i < above.size(); ++i) {
        double entry = std::clamp(above[i] * scale + 0.5, 0.0, last);
        words[i] = above[i] == above[i] ? table[static_cast<std::size_t>(entry)] : plainColourWord;
    }
    return words;
}

// Half of each.
std::uint32_t tinted(std::uint32_t word, std::uint32_t tint) {
    constexpr std::uint32_t lowBits = 0x00010101;
    std::uint32_t a = word & colourMask, b = tint & colourMask;
    return (word & ~colourMask) | ((a & b) + (((a ^ b) & ~lowBits) >> 1));
}

} // namespace

bool passes(const AttributeFilter& filter, const Attribute& attribute, double value) {
    bool scaled = attribute.scale != 1 || attribute.offset != 0;
    double slack = scaled ? 1e-6 * std::abs(attribute.scale) : 0;
    return value >= filter.min - slack && value <= filter.max + slack;
}

std::shared_ptr<const NodePaint> Painter::paint(const PaintedNode& node) const {
    auto paint = std::make_shared<NodePaint>();
    bool rgb = style_.colourMode == ColourMode::rgb, changes = changesPoints(node);
    if (rgb && !changes) {
        ByteSpan exact = node.exact ? findColumn(node, exactColourWords) : ByteSpan();
        if (exact.empty())
            return nullptr;
    }
    Words words;
    if (style_.colourMode == ColourMode::mix)
        words = mixed(node);
    else
        words = colours(node, style_.colourMode, style_.attribute, rangeOf(style_.colourMode));
    if (words.empty())
        words.assign(node.node->pointCount, plainColourWord);
    if (changes) {
        applyFilters(node, words);
        applyClips(node, words);
    }
    paint->id = nextResidentNodeId();
    paint->hidden = static_cast<std::uint32_t>(
        std::count_if(words.begin(), words.end(), [](std::uint32_t word) { return (word >> 24) == 0; }));
    paint->words = std::make_shared<const Words>(std::move(words));
    return paint;
}

bool Painter::changesPoints(const PaintedNode& node) const {
    if (style_.hiddenClasses.any() || !style_.filters.empty())
        return true;
    ClipVerdict verdict = clips_.clipVerdict(node.box);
    return verdict.hidden || verdict.tested || verdict.highlighted;
}

const Range& Painter::rangeOf(ColourMode mode) const {
    switch (mode) {
    case ColourMode::intensity:
        return style_.intensityRange;
    case ColourMode::elevation:
        return style_.elevationRange;
    case ColourMode::level:
        return style_.levelRange;
    default:
        return style_.attributeRange;
    }
}

// --- colours -------------------------------------------------------------------------------------------

Painter::Words Painter::colours(const PaintedNode& node, ColourMode mode, const std::string& attribute,
                                const Range& range) const {
    if (mode == ColourMode::rgb)
        return ownWords(node);
    if (mode == ColourMode::classification)
        return classWords(node);
    return alongGradient(gradientTable(style_.gradient), values(node, mode, attribute, range.min),
                         range.max - range.min);
}

Painter::Words Painter::ownWords(const PaintedNode& node) const {
    ByteSpan exact = node.exact ? findColumn(node, exactColourWords) : ByteSpan();
    if (exact.empty())
        return node.node->colourWords;
    Words words(node.node->pointCount);
    for (std::size_t i = 0; i < words.size(); ++i)
        words[i] = loadLe<std::uint32_t>(exact.data() + 4 * i);
    return words;
}

Painter::Words Painter::classWords(const PaintedNode& node) const {
    std::vector<double> classes =
        attributeValues(node, findAttribute(schema_, attribute_names::classification));
    Words words(classes.size());
    for (std::size_t i = 0; i < words.size(); ++i)
        words[i] = classes[i] >= 0 && classes[i] <= 255
                       ? wordOf(classColour(static_cast<std::uint8_t>(classes[i])))
                       : plainColourWord;
    return words;
}

Painter::Words Painter::mixed(const PaintedNode& node) const {
    std::vector<std::array<float, 3>> sums(node.node->pointCount);
    double weights = 0;
    for (const MixedColour& one : style_.mix) {
        Words words = colours(node, one.mode, one.attribute, one.range);
        if (words.empty())
            continue; // the cloud has nothing of the kind
        weights += one.weight;
        for (std::size_t i = 0; i < words.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c)
                sums[i][c] += static_cast<float>(one.weight) * static_cast<float>(words[i] >> (8 * c) & 255);
    }
    if (weights <= 0)
        return {};
    Words words(sums.size());
    auto share = static_cast<float>(1 / weights);
    for (std::size_t i = 0; i < words.size(); ++i) {
        auto level = [&](std::size_t c) {
            return static_cast<std::uint8_t>(std::min(sums[i][c] * share + 0.5f, 255.0f));
        };
        words[i] = wordOf({level(0), level(1), level(2)});
    }
    return words;
}

// --- values --------------------------------------------------------------------------------------------

std::vector<double> Painter::values(const PaintedNode& node, ColourMode mode, const std::string& attribute,
                                    double from) const {
    if (mode == ColourMode::elevation)
        return elevations(node, from);
    std::vector<double> found =
        mode == ColourMode::level
            ? levels(node)
            : attributeValues(node, findAttribute(schema_, attributeOf(mode, attribute)));
    for (double& value : found)
        value -= from;
    return found;
}

std::vector<double> Painter::attributeValues(const PaintedNode& node, int attribute) const {
    if (attribute < 0)
        return {};
    std::size_t count = node.node->pointCount;
    const Attribute& known = schema_.attributes[static_cast<std::size_t>(attribute)];
    ByteSpan column = findColumn(node, attribute);
    if (column.empty() && known.name == attribute_names::intensity) {
        column = node.exact ? findColumn(node, exactIntensity) : ByteSpan();
        if (column.empty())
            column = findColumn(node, pictureIntensity);
    }
    if (!column.empty())
        return meaningsOf(known, column, count);
    // Colours: what the picture shows of them, to eight bits.
    int channel = channelOf(known);
    Words words = channel >= 0 ? ownWords(node) : Words();
    std::vector<double> levels(words.size());
    for (std::size_t i = 0; i < words.size(); ++i)
        levels[i] = static_cast<double>(words[i] >> (8 * channel) & 255) * (colourIs8Bit_ ? 1 : 256);
    return levels;
}

// The difference of two large heights, without their rounding.
std::vector<double> Painter::elevations(const PaintedNode& node, double from) const {
    GridPosition start = gridPosition(from, grid_.offset.z, grid_.scale.z);
    auto base = static_cast<double>(node.corner.z - start.cell) - start.fraction;
    std::vector<double> heights(node.node->pointCount);
    for (std::size_t i = 0; i < heights.size(); ++i)
        heights[i] = (base + positionOf(*node.node, i).z) * grid_.scale.z;
    return heights;
}

std::vector<double> Painter::levels(const PaintedNode& node) const {
    std::vector<double> found(node.node->pointCount, node.node->key.level);
    if (continuous_)
        for (std::uint32_t i = 0; i < node.node->pointCount; ++i)
            found[i] = rankLevel(node.density, node.rootSpacing, i);
    return found;
}

// --- hiding --------------------------------------------------------------------------------------------

void Painter::applyFilters(const PaintedNode& node, Words& words) const {
    if (style_.hiddenClasses.any()) {
        std::vector<double> classes =
            attributeValues(node, findAttribute(schema_, attribute_names::classification));
        for (std::size_t i = 0; i < classes.size(); ++i)
            if (classes[i] >= 0 && classes[i] <= 255 &&
                style_.hiddenClasses[static_cast<std::size_t>(classes[i])])
                words[i] &= colourMask;
    }
    for (const AttributeFilter& filter : style_.filters) {
        int attribute = findAttribute(schema_, filter.attribute);
        std::vector<double> found = attributeValues(node, attribute);
        for (std::size_t i = 0; i < found.size(); ++i)
            if (!passes(filter, schema_.attributes[static_cast<std::size_t>(attribute)], found[i]))
                words[i] &= colourMask;
    }
}

void Painter::applyClips(const PaintedNode& node, Words& words) const {
    ClipVerdict verdict = clips_.clipVerdict(node.box);
    if (verdict.hidden)
        for (std::uint32_t& word : words)
            word &= colourMask;
    if (!verdict.tested && !verdict.highlighted)
        return;
    Clips near = clips_.near(node.box);
    std::uint32_t tint = wordOf(style_.highlight);
    for (std::size_t i = 0; i < words.size(); ++i) {
        Vec3<std::uint32_t> p = positionOf(*node.node, i);
        Vec3d world = grid_.toWorld({node.corner.x + p.x, node.corner.y + p.y, node.corner.z + p.z});
        if (verdict.tested && near.hides(world))
            words[i] &= colourMask;
        else if (verdict.highlighted && near.highlights(world))
            words[i] = tinted(words[i], tint);
    }
}

} // namespace stipple
