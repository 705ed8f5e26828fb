#include "client/reference/marks.hpp"

#include "client/core/gradients.hpp"
#include "client/core/node_normals.hpp"
#include "shared/base/bytes.hpp"
#include "shared/points/point_classes.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace stipple::reference {
namespace {

constexpr Colour withoutValue{180, 180, 180};

double storedOf(const Points& points, int column, std::size_t i) {
    const Attribute& attribute = points.attributes[static_cast<std::size_t>(column)];
    const std::uint8_t* at =
        points.batch->columns[static_cast<std::size_t>(column)].data() + i * attribute.size();
    switch (attribute.type) {
    case AttributeType::u8:
        return loadLe<std::uint8_t>(at);
    case AttributeType::i8:
        return loadLe<std::int8_t>(at);
    case AttributeType::u16:
        return loadLe<std::uint16_t>(at);
    case AttributeType::i16:
        return loadLe<std::int16_t>(at);
    case AttributeType::u32:
        return loadLe<std::uint32_t>(at);
    case AttributeType::i32:
        return loadLe<std::int32_t>(at);
    case AttributeType::u64:
        return static_cast<double>(loadLe<std::uint64_t>(at));
    case AttributeType::i64:
        return static_cast<double>(loadLe<std::int64_t>(at));
    case AttributeType::f32:
        return double{loadLe<float>(at)};
    case AttributeType::f64:
        return loadLe<double>(at);
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
    for (std::size_t i = 0; i < count; ++i) {
        double at = value(i);
        colours[i] =
            std::isnan(at) ? withoutValue : gradientAt(table, (at - range.min) / (range.max - range.min));
    }
    return colours;
}

// 16-bit channels by their upper byte: writers disagree whether 0xFF00 or 0xFFFF is full.
std::vector<Colour> rgbOf(const Points& points) {
    std::vector<Colour> colours(points.batch->size(), withoutValue);
    const std::array<int, 3> columns{columnOf(points, attribute_names::red),
                                     columnOf(points, attribute_names::green),
                                     columnOf(points, attribute_names::blue)};
    if (std::find(columns.begin(), columns.end(), -1) != columns.end())
        return {};
    for (std::size_t i = 0; i < colours.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            double value = storedOf(points, columns[c], i);
            colours[i][c] =
                static_cast<float>(points.colourIs8Bit ? std::min(value, 255.0) : std::floor(value / 256));
        }
    return colours;
}

} // namespace

int columnOf(const Points& points, std::string_view name) {
    auto same = [&](const std::string& other) {
        return std::equal(
            other.begin(), other.end(), name.begin(), name.end(),
            [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); });
    };
    for (std::size_t a = 0; a < points.attributes.size(); ++a)
        if (same(points.attributes[a].name))
            return static_cast<int>(a);
    return -1;
}

double meaningOf(const Points& points, int column, std::size_t i) {
    const Attribute& attribute = points.attributes[static_cast<std::size_t>(column)];
    double stored = storedOf(points, column, i);
    return attribute.noData && stored == *attribute.noData ? std::nan("")
                                                           : attribute.offset + attribute.scale * stored;
}

Vec3l worldOf(const Points& points, std::size_t i) {
    const Grid& grid = *points.grid;
    const Vec3i& p = points.batch->positions[i];
    Vec3l world;
    for (int axis = 0; axis < 3; ++axis)
        world[axis] = static_cast<long double>(grid.offset[axis]) +
                      static_cast<long double>(grid.scale[axis]) * static_cast<long double>(p[axis]);
    return world;
}

std::vector<std::string_view> neededAttributes(const Style& style, const CloudMetadata& metadata) {
    using namespace attribute_names;
    std::vector<std::string_view> wanted;
    auto add = [&](ColourMode mode, const std::string& attribute) {
        if (mode == ColourMode::rgb) {
            if (metadata.pictureColour == PictureColour::rgb)
                wanted.insert(wanted.end(), {red, green, blue});
        } else if (std::string_view name = attributeOf(mode, attribute); !name.empty()) {
            wanted.push_back(name);
        }
    };
    add(style.colourMode, style.attribute);
    if (style.colourMode == ColourMode::mix)
        for (const MixedColour& one : style.mix)
            add(one.mode, one.attribute);
    if (style.hiddenClasses.any())
        wanted.push_back(classification);
    for (const AttributeFilter& filter : style.filters)
        wanted.push_back(filter.attribute);
    if (auto normals = normalAttributes(metadata.schema); normals && style.shape == PointShape::disc)
        for (int index : *normals)
            wanted.push_back(metadata.schema.attributes[static_cast<std::size_t>(index)].name);
    Points cloud;
    cloud.attributes = metadata.schema.attributes;
    std::vector<std::string_view> had;
    for (std::string_view name : wanted) {
        int column = columnOf(cloud, name);
        if (column < 0)
            continue;
        std::string_view known = metadata.schema.attributes[static_cast<std::size_t>(column)].name;
        if (std::find(had.begin(), had.end(), known) == had.end())
            had.push_back(known);
    }
    return had;
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

namespace {

double levelOf(const Style& style, const Points& points, std::size_t i) {
    if (style.detail.mode == DetailMode::discrete)
        return points.level;
    // client/core/continuous_detail.hpp: how many times as dense as the level above, and four times is a
    // level.
    double nth = static_cast<double>(i), half = 0.5;
    if (points.level == 0)
        return std::log((nth + half) / points.nodePoints) / std::log(4.0);
    double share = 3 / points.nodePoints;
    return points.level - 1 +
           std::log(1 + half * share + nth * std::max(share, points.leafStep)) / std::log(4.0);
}

// Empty: the cloud has nothing of that kind.
std::vector<Colour> coloursOf(const Style& style, const Points& points, ColourMode mode,
                              const std::string& attribute, const Range& range) {
    std::size_t count = points.batch->size();
    if (mode == ColourMode::rgb)
        return rgbOf(points);
    if (mode == ColourMode::elevation)
        return ramp(style, range, count,
                    [&](std::size_t i) { return static_cast<double>(worldOf(points, i).z); });
    if (mode == ColourMode::level)
        return ramp(style, range, count, [&](std::size_t i) { return levelOf(style, points, i); });
    int column = columnOf(points, attributeOf(mode, attribute));
    if (column < 0)
        return {};
    if (mode != ColourMode::classification)
        return ramp(style, range, count, [&](std::size_t i) { return meaningOf(points, column, i); });
    std::vector<Colour> colours(count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            colours[i][c] = classColour(static_cast<std::uint8_t>(meaningOf(points, column, i)))[c];
    return colours;
}

std::vector<Colour> mixedOf(const Style& style, const Points& points) {
    std::vector<Colour> sum(points.batch->size());
    std::vector<std::vector<Colour>> parts;
    std::vector<double> weights;
    double all = 0;
    for (const MixedColour& one : style.mix) {
        std::vector<Colour> colours = coloursOf(style, points, one.mode, one.attribute, one.range);
        if (colours.empty())
            continue;
        parts.push_back(std::move(colours));
        weights.push_back(one.weight);
        all += one.weight;
    }
    for (std::size_t part = 0; part < parts.size(); ++part)
        for (std::size_t i = 0; i < sum.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c)
                sum[i][c] += static_cast<float>(weights[part] / all) * parts[part][i][c];
    return parts.empty() ? std::vector<Colour>() : sum;
}

Range rangeOf(const Style& style) {
    switch (style.colourMode) {
    case ColourMode::intensity:
        return style.intensityRange;
    case ColourMode::elevation:
        return style.elevationRange;
    case ColourMode::level:
        return style.levelRange;
    default:
        return style.attributeRange;
    }
}

} // namespace

std::vector<Colour> coloursOf(const Style& style, const Points& points) {
    std::vector<Colour> colours =
        style.colourMode == ColourMode::mix
            ? mixedOf(style, points)
            : coloursOf(style, points, style.colourMode, style.attribute, rangeOf(style));
    if (colours.empty())
        colours.assign(points.batch->size(), withoutValue);
    return colours;
}

namespace {

// Normals of the points in the camera's axes; zero where there is none.
std::vector<Vec3d> normalsOf(const View& view, const Points& points) {
    std::vector<Vec3d> normals(points.batch->size());
    auto columns = normalAttributes({points.attributes});
    for (std::size_t i = 0; columns && i < normals.size(); ++i) {
        Vec3d n{meaningOf(points, (*columns)[0], i), meaningOf(points, (*columns)[1], i),
                meaningOf(points, (*columns)[2], i)};
        double size = std::hypot(n.x, n.y, n.z);
        if (std::isfinite(size) && size > 0)
            normals[i] = Vec3d{dot(n, view.right), dot(n, view.up), dot(n, view.forward)} * (1 / size);
    }
    return normals;
}

} // namespace

void appendMarks(const View& view, const Style& style, const Points& points, std::vector<Mark>& marks) {
    std::vector<Colour> colours = coloursOf(style, points);
    highlight(style, points, colours);
    std::vector<bool> shown = shownOf(style, points);
    bool discs = style.shape == PointShape::disc;
    std::vector<Vec3d> normals = discs ? normalsOf(view, points) : std::vector<Vec3d>(points.batch->size());
    for (std::size_t i = 0; i < points.batch->size(); ++i) {
        Place at;
        if (!shown[i] || !place(view, worldOf(points, i), at))
            continue;
        double spacing = points.spacings.empty() ? 0 : points.spacings[i];
        double diameter = diameterOf(style, view, at.distance, spacing);
        double reach = (discs ? mostDiscReach : diameter / 2) + 1;
        if (at.x + reach < 0 || at.y + reach < 0 || at.x - reach > view.width || at.y - reach > view.height)
            continue;
        Mark mark{at.x,
                  at.y,
                  at.distance,
                  diameter,
                  points.firstOrder + i,
                  colours[i],
                  1 / view.pixelsPerUnitAt(at.distance),
                  normals[i]};
        if (view.projection == Projection::perspective) {
            mark.rayX = (at.x - 0.5 * view.width) / view.pixelsPerUnit;
            mark.rayY = (0.5 * view.height - at.y) / view.pixelsPerUnit;
            mark.slopePerPixel = 1 / view.pixelsPerUnit;
        }
        mark.near = view.near;
        mark.far = view.far;
        marks.push_back(mark);
    }
}

} // namespace stipple::reference
