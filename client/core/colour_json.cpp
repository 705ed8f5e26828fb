#include "client/core/colour_json.hpp"

#include "client/core/clips.hpp"
#include "shared/select/region_json.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stipple {

using nlohmann::json;

namespace {

using json_fields::FieldReader;
using json_fields::nameOf;
using json_fields::Names;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largestCoordinate = 1e99; // shared/geometry/half_space.hpp

constexpr Names<ColourMode, 11> colourModes{{
    {"rgb", ColourMode::rgb},
    {"intensity", ColourMode::intensity},
    {"elevation", ColourMode::elevation},
    {"classification", ColourMode::classification},
    {"returnNumber", ColourMode::returnNumber},
    {"numberOfReturns", ColourMode::numberOfReturns},
    {"pointSourceId", ColourMode::pointSourceId},
    {"gpsTime", ColourMode::gpsTime},
    {"level", ColourMode::level},
    {"attribute", ColourMode::attribute},
    {"mix", ColourMode::mix},
}};
constexpr Names<GradientName, 6> gradients{{
    {"viridis", GradientName::viridis},
    {"turbo", GradientName::turbo},
    {"inferno", GradientName::inferno},
    {"spectral", GradientName::spectral},
    {"grey", GradientName::grey},
    {"terrain", GradientName::terrain},
}};
constexpr Names<ClipMode, 3> clipModes{{
    {"highlight", ClipMode::highlight},
    {"hideInside", ClipMode::hideInside},
    {"hideOutside", ClipMode::hideOutside},
}};

json rangeJson(const Range& range) {
    return range.min == range.max ? json(nullptr) : json::array({range.min, range.max});
}
json vectorJson(const Vec3d& v) {
    return json::array({v.x, v.y, v.z});
}
json limitJson(double limit) {
    return std::isfinite(limit) ? json(limit) : json(nullptr);
}

Status readMixed(const json& item, const std::string& path, ColourStyle& style) {
    MixedColour one;
    FieldReader fields(item, path);
    fields.choice("colourMode", one.mode, colourModes);
    if (one.mode == ColourMode::mix)
        fields.fail("colourMode", say("can't be a mix inside a mix"));
    fields.text("attribute", one.attribute);
    if (one.mode == ColourMode::attribute && one.attribute.empty())
        fields.fail("attribute", say("must name the attribute"));
    fields.range("range", one.range);
    fields.number("weight", one.weight, 1e-6, 1e6);
    style.mix.push_back(std::move(one));
    return fields.finish();
}

Status readClass(const json& item, const std::string& path, ColourStyle& style) {
    if (!item.is_number_integer() || item < 0 || item > 255)
        return Error{ErrorCode::invalidArgument, say("a class is a whole number from 0 to 255"), path, ""};
    style.hiddenClasses.set(item.get<std::size_t>());
    return {};
}

Status readFilter(const json& item, const std::string& path, ColourStyle& style) {
    AttributeFilter filter;
    FieldReader fields(item, path);
    fields.text("attribute", filter.attribute);
    if (filter.attribute.empty())
        fields.fail("attribute", say("must name an attribute"));
    fields.limit("min", filter.min, -infinity);
    fields.limit("max", filter.max, infinity);
    if (filter.min > filter.max)
        fields.fail("min", say("must not exceed max"));
    style.filters.push_back(std::move(filter));
    return fields.finish();
}

bool isOrthonormal(const BoxAxes& axes) {
    constexpr double slack = 1e-6;
    for (std::size_t i = 0; i < 3; ++i)
        if (std::abs(dot(axes[i], axes[i]) - 1) > slack || std::abs(dot(axes[i], axes[(i + 1) % 3])) > slack)
            return false;
    return true;
}

void readTurn(FieldReader& fields, const json& item, ClipBox& box) {
    std::array<double, 4> rotation{};
    if (fields.numbersOf("rotation", rotation, 1e100)) {
        if (item.contains("axes"))
            return fields.fail("axes", say("can't be given beside a rotation"));
        if (auto axes = axesOfQuaternion(rotation[0], rotation[1], rotation[2], rotation[3]))
            box.axes = *axes;
        else
            fields.fail("rotation", say("must not be zero"));
    }
    std::size_t at = 0;
    fields.list("axes", 3, [&](const json& axis, const std::string& path) -> Status {
        json named{{"axis", axis}};
        FieldReader vector(named, path);
        vector.vector("axis", box.axes[at++], 2);
        return vector.finish();
    });
    if (at != 0 && (at != 3 || !isOrthonormal(box.axes)))
        fields.fail("axes", say("must be three unit vectors at right angles"));
}

Status readClipBox(const json& item, const std::string& path, ColourStyle& style) {
    ClipBox box{{0, 0, 0}, {1, 1, 1}};
    FieldReader fields(item, path);
    fields.choice("mode", box.mode, clipModes);
    fields.vector("centre", box.centre, largestCoordinate);
    fields.vector("halfSize", box.halfSize, largestCoordinate);
    if (std::min({box.halfSize.x, box.halfSize.y, box.halfSize.z}) < 0)
        fields.fail("halfSize", say("must not be negative"));
    if (item.is_object())
        readTurn(fields, item, box);
    STIPPLE_CHECK(fields.finish());
    auto usable = Clips::make({&box, 1});
    if (!usable.ok())
        return usable.error().at(path);
    style.clipBoxes.push_back(box);
    return {};
}

Status readClipRegion(const json& item, const std::string& path, ColourStyle& style) {
    ClipRegion clip;
    FieldReader fields(item, path);
    fields.choice("mode", clip.mode, clipModes);
    fields.allow("region");
    STIPPLE_CHECK(fields.finish());
    if (auto region = item.find("region"); region != item.end()) {
        STIPPLE_TRY(shape, shapeFromJson(*region, path + ".region"));
        clip.shape = std::move(shape);
    }
    if (clip.shape.isEverywhere())
        return Error{ErrorCode::invalidArgument,
                     say("'region' must be given, with a polygon, line, prism, box or heights"), path, ""};
    std::size_t corners = clip.shape.cornerCount();
    for (const ClipRegion& other : style.clipRegions)
        corners += other.shape.cornerCount();
    if (corners > maxClipCorners)
        return Error{ErrorCode::limitExceeded,
                     say("clip regions may have ", maxClipCorners, " corners together"), path,
                     say("simplify the polygons, or export what lies in them")};
    if (auto usable = filterOf(clip.shape); !usable)
        return inRegion(path + ".region", usable.error());
    style.clipRegions.push_back(std::move(clip));
    return {};
}

json clipBoxJson(const ClipBox& box) {
    return {
        {"mode", nameOf(clipModes, box.mode)},
        {"centre", vectorJson(box.centre)},
        {"halfSize", vectorJson(box.halfSize)},
        {"axes", json::array({vectorJson(box.axes[0]), vectorJson(box.axes[1]), vectorJson(box.axes[2])})}};
}

// A list of the style that the field, if it is there, replaces.
template <class List, class Read>
void readList(FieldReader& fields, const char* name, std::size_t most, ColourStyle& style,
              List ColourStyle::*list, Read read) {
    ColourStyle fresh;
    bool given = fields.list(
        name, most, [&](const json& item, const std::string& path) { return read(item, path, fresh); });
    if (given)
        style.*list = std::move(fresh.*list);
}

} // namespace

void readColourMode(FieldReader& fields, ColourMode& mode) {
    fields.choice("colourMode", mode, colourModes);
}

void readColours(FieldReader& fields, ColourStyle& style) {
    readColourMode(fields, style.colourMode);
    fields.choice("gradient", style.gradient, gradients);
    fields.range("intensityRange", style.intensityRange);
    fields.range("elevationRange", style.elevationRange);
    fields.range("levelRange", style.levelRange);
    fields.text("attribute", style.attribute);
    fields.range("attributeRange", style.attributeRange);
    readList(fields, "mix", maxMixedColours, style, &ColourStyle::mix, readMixed);
    readList(fields, "hiddenClasses", 256, style, &ColourStyle::hiddenClasses, readClass);
    readList(fields, "filters", maxAttributeFilters, style, &ColourStyle::filters, readFilter);
    readList(fields, "clipBoxes", maxClipBoxes, style, &ColourStyle::clipBoxes, readClipBox);
    readList(fields, "clipRegions", maxClipRegions, style, &ColourStyle::clipRegions, readClipRegion);
    fields.bytes("highlight", style.highlight);
    if (style.colourMode == ColourMode::attribute && style.attribute.empty())
        fields.fail("attribute", say("must name the attribute that colours the points"));
    if (style.colourMode == ColourMode::mix && style.mix.empty())
        fields.fail("mix", say("must name the colours to mix"));
}

json coloursJson(const ColourStyle& style) {
    json mix = json::array(), classes = json::array(), filters = json::array(), boxes = json::array(),
         regions = json::array();
    for (const MixedColour& one : style.mix)
        mix.push_back({{"colourMode", nameOf(colourModes, one.mode)},
                       {"attribute", one.attribute},
                       {"range", rangeJson(one.range)},
                       {"weight", one.weight}});
    for (std::size_t c = 0; c < style.hiddenClasses.size(); ++c)
        if (style.hiddenClasses[c])
            classes.push_back(c);
    for (const AttributeFilter& filter : style.filters)
        filters.push_back({{"attribute", filter.attribute},
                           {"min", limitJson(filter.min)},
                           {"max", limitJson(filter.max)}});
    for (const ClipBox& box : style.clipBoxes)
        boxes.push_back(clipBoxJson(box));
    for (const ClipRegion& clip : style.clipRegions)
        regions.push_back({{"mode", nameOf(clipModes, clip.mode)}, {"region", toJson(clip.shape)}});
    return {{"colourMode", nameOf(colourModes, style.colourMode)},
            {"gradient", nameOf(gradients, style.gradient)},
            {"intensityRange", rangeJson(style.intensityRange)},
            {"elevationRange", rangeJson(style.elevationRange)},
            {"levelRange", rangeJson(style.levelRange)},
            {"attribute", style.attribute},
            {"attributeRange", rangeJson(style.attributeRange)},
            {"mix", std::move(mix)},
            {"hiddenClasses", std::move(classes)},
            {"filters", std::move(filters)},
            {"clipBoxes", std::move(boxes)},
            {"clipRegions", std::move(regions)},
            {"highlight", style.highlight}};
}

std::vector<std::string> colourModeNames() {
    std::vector<std::string> names;
    for (const auto& [name, mode] : colourModes)
        names.emplace_back(name);
    return names;
}

} // namespace stipple
