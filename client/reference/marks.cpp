#include "client/reference/marks.hpp"

#include "client/render/gradients.hpp"
#include "shared/base/bytes.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::reference {
namespace {

constexpr Colour withoutValue{180, 180, 180};

Vec3l worldOf(const Points& points, std::size_t i) {
    const Grid& grid = *points.grid;
    const Vec3i& p = points.batch->positions[i];
    Vec3l world;
    for (int axis = 0; axis < 3; ++axis)
        world[axis] = static_cast<long double>(grid.offset[axis]) +
                      static_cast<long double>(grid.scale[axis]) * static_cast<long double>(p[axis]);
    return world;
}

int columnOf(const Points& points, std::string_view name) {
    for (std::size_t a = 0; a < points.attributes.size(); ++a)
        if (points.attributes[a].name == name)
            return static_cast<int>(a);
    return -1;
}

double valueOf(const Points& points, int column, std::size_t i) {
    const PointBatch& batch = *points.batch;
    switch (points.attributes[static_cast<std::size_t>(column)].type) {
    case AttributeType::u8:
        return batch.value<std::uint8_t>(column, i);
    case AttributeType::i8:
        return batch.value<std::int8_t>(column, i);
    case AttributeType::u16:
        return batch.value<std::uint16_t>(column, i);
    case AttributeType::i16:
        return batch.value<std::int16_t>(column, i);
    case AttributeType::u32:
        return batch.value<std::uint32_t>(column, i);
    case AttributeType::i32:
        return batch.value<std::int32_t>(column, i);
    case AttributeType::u64:
        return static_cast<double>(batch.value<std::uint64_t>(column, i));
    case AttributeType::i64:
        return static_cast<double>(batch.value<std::int64_t>(column, i));
    case AttributeType::f32:
        return double{batch.value<float>(column, i)};
    case AttributeType::f64:
        return batch.value<double>(column, i);
    }
    return 0;
}

// The gradient at t in 0..1, between the entries of its table.
Colour gradientAt(const GradientTable& table, double t) {
    double at = std::clamp(t, 0.0, 1.0) * (gradientEntries - 1);
    auto entry = std::min(static_cast<std::size_t>(at), std::size_t{gradientEntries - 2});
    double part = at - static_cast<double>(entry);
    Colour colour;
    for (std::size_t c = 0; c < 3; ++c) {
        double low = table[entry] >> (8 * c) & 255, high = table[entry + 1] >> (8 * c) & 255;
        colour[c] = static_cast<float>(low + (high - low) * part);
    }
    return colour;
}

// The colour of each value along the style's gradient.
template <class Value>
std::vector<Colour> ramp(const Style& style, const Range& range, std::size_t count, const Value& value) {
    const GradientTable& table = gradientTable(style.gradient);
    std::vector<Colour> colours(count);
    for (std::size_t i = 0; i < count; ++i)
        colours[i] = gradientAt(table, (value(i) - range.min) / (range.max - range.min));
    return colours;
}

// 16-bit channels by their upper byte: writers disagree whether 0xFF00 or 0xFFFF is full.
std::vector<Colour> rgbOf(const Points& points) {
    std::vector<Colour> colours(points.batch->size(), withoutValue);
    const std::array<int, 3> columns{columnOf(points, attribute_names::red),
                                     columnOf(points, attribute_names::green),
                                     columnOf(points, attribute_names::blue)};
    if (std::find(columns.begin(), columns.end(), -1) != columns.end())
        return colours;
    for (std::size_t i = 0; i < colours.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            double value = valueOf(points, columns[c], i);
            colours[i][c] =
                static_cast<float>(points.colourIs8Bit ? std::min(value, 255.0) : std::floor(value / 256));
        }
    return colours;
}

} // namespace

std::vector<std::string_view> neededAttributes(const Style& style, const CloudMetadata& metadata) {
    using namespace attribute_names;
    if (style.colourMode == ColourMode::rgb && metadata.pictureColour == PictureColour::rgb)
        return {red, green, blue};
    if (style.colourMode == ColourMode::intensity && metadata.schema.find(intensity) >= 0)
        return {intensity};
    return {};
}

double diameterOf(const Style& style, const View& view, double distance, double spacing) {
    double wanted = style.sizePixels;
    if (style.sizeMode == PointSizeMode::world)
        wanted = style.sizeWorld * view.pixelsPerUnitAt(distance);
    if (style.sizeMode == PointSizeMode::adaptive)
        wanted = style.sizeSpacings * spacing * view.pixelsPerUnitAt(distance);
    double least = std::max(1.0, style.minSizePixels),
           most = std::max(least, std::min(255.0, style.maxSizePixels));
    return std::clamp(wanted, least, most);
}

std::vector<Colour> coloursOf(const Style& style, const Points& points) {
    std::size_t count = points.batch->size();
    switch (style.colourMode) {
    case ColourMode::rgb:
        return rgbOf(points);
    case ColourMode::intensity: {
        int column = columnOf(points, attribute_names::intensity);
        if (column < 0)
            return std::vector<Colour>(count, withoutValue);
        return ramp(style, style.intensityRange, count,
                    [&](std::size_t i) { return valueOf(points, column, i); });
    }
    case ColourMode::elevation:
        return ramp(style, style.elevationRange, count,
                    [&](std::size_t i) { return static_cast<double>(worldOf(points, i).z); });
    }
    return std::vector<Colour>(count, withoutValue);
}

void appendMarks(const View& view, const Style& style, const Points& points, std::vector<Mark>& marks) {
    std::vector<Colour> colours = coloursOf(style, points);
    for (std::size_t i = 0; i < points.batch->size(); ++i) {
        Place at;
        if (!place(view, worldOf(points, i), at))
            continue;
        double spacing = points.spacings.empty() ? 0 : points.spacings[i];
        double diameter = diameterOf(style, view, at.distance, spacing), reach = diameter / 2 + 1;
        if (at.x + reach < 0 || at.y + reach < 0 || at.x - reach > view.width || at.y - reach > view.height)
            continue;
        marks.push_back({at.x, at.y, at.distance, diameter, points.firstOrder + i, colours[i],
                         1 / view.pixelsPerUnitAt(at.distance)});
    }
}

} // namespace stipple::reference
