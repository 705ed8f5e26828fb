#include "client/core/json/view_json.hpp"

#include "client/core/json/json_fields.hpp"

namespace stipple {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array projectionNames{"perspective", "orthographic"};
constexpr std::array colourModeNames{"rgb", "intensity", "elevation"};
constexpr std::array sizeModeNames{"fixed", "world"};
constexpr std::array shapeNames{"square", "circle"};
constexpr std::array gradientNames{"viridis", "turbo", "inferno", "spectral", "grey", "terrain"};

constexpr double huge = 1e15;
constexpr double maxExact = 9007199254740991; // 2^53 - 1: the largest integer that JSON numbers hold exactly

Json vectorJson(const Vec3d& v) {
    return Json::array({v.x, v.y, v.z});
}
Json rangeJson(const Range& range) {
    return Json::array({range.min, range.max});
}

void readRange(JsonFields& fields, const char* key, Range& range) {
    std::array<double, 2> ends{range.min, range.max};
    fields.numbers(key, ends, -huge, huge);
    if (ends[0] > ends[1])
        fields.refuse(key, "must not end before it begins");
    range = {ends[0], ends[1]};
}

void readVector(JsonFields& fields, const char* key, Vec3d& v) {
    std::array<double, 3> numbers{v.x, v.y, v.z};
    fields.numbers(key, numbers, -huge, huge);
    v = {numbers[0], numbers[1], numbers[2]};
}

template <class T, class Read>
Status update(T& value, const char* name, std::string_view json, Read&& read) {
    STIPPLE_TRY(fields, JsonFields::parse(json, name));
    T changed = value;
    read(fields, changed);
    STIPPLE_CHECK(fields.finish());
    value = changed;
    return {};
}

void readEdl(JsonFields& fields, EyeDomeLighting& edl) {
    fields.boolean("enabled", edl.enabled);
    fields.integer("neighbours", edl.neighbours, 4, 8);
    if (edl.neighbours != 4 && edl.neighbours != 8)
        fields.refuse("neighbours", "must be 4 or 8");
    fields.number("radiusPixels", edl.radiusPixels, 0, 64);
    fields.number("strength", edl.strength, 0, 100);
}

} // namespace

Status updateCamera(Camera& camera, std::string_view json) {
    return update(camera, "camera", json, [](JsonFields& fields, Camera& c) {
        fields.choice("projection", c.projection, projectionNames);
        readVector(fields, "position", c.position);
        readVector(fields, "target", c.target);
        readVector(fields, "up", c.up);
        fields.number("fovYDegrees", c.fovYDegrees, 1, 170);
        fields.number("orthoHeight", c.orthoHeight, 1e-9, huge);
        Vec3d direction = c.target - c.position;
        if (!(length(direction) > 0))
            fields.refuse("target", "must differ from position");
        else if (!(length(cross(direction, c.up)) > 0))
            fields.refuse("up", "must not be parallel to the direction of view");
    });
}

Status updateStyle(Style& style, std::string_view json) {
    return update(style, "style", json, [](JsonFields& fields, Style& s) {
        fields.choice("colourMode", s.colourMode, colourModeNames);
        fields.choice("gradient", s.gradient, gradientNames);
        readRange(fields, "intensityRange", s.intensityRange);
        readRange(fields, "elevationRange", s.elevationRange);
        fields.choice("sizeMode", s.sizeMode, sizeModeNames);
        fields.number("sizePixels", s.sizePixels, 0.1, 1024);
        fields.number("sizeWorld", s.sizeWorld, 0, huge);
        fields.number("minSizePixels", s.minSizePixels, 0.1, 1024);
        fields.number("maxSizePixels", s.maxSizePixels, 0.1, 1024);
        if (s.minSizePixels > s.maxSizePixels)
            fields.refuse("minSizePixels", "must not exceed maxSizePixels");
        fields.choice("shape", s.shape, shapeNames);
        fields.object("edl", [&](JsonFields& inner) { readEdl(inner, s.edl); });
        std::array<double, 3> background{};
        std::copy(s.background.begin(), s.background.end(), background.begin());
        fields.numbers("background", background, 0, 255);
        for (std::size_t i = 0; i < 3; ++i)
            s.background[i] = static_cast<std::uint8_t>(background[i]);
    });
}

Status updateLimits(SessionLimits& limits, std::string_view json) {
    return update(limits, "limits", json, [](JsonFields& fields, SessionLimits& l) {
        fields.integer("pointBudget", l.pointBudget, 1, maxExact);
        fields.number("minNodePixels", l.minNodePixels, 0, 1e6);
        fields.integer("cacheBytes", l.cacheBytes, 1 << 20, maxExact);
        fields.integer("requestsInFlight", l.requestsInFlight, 1, 1024);
        fields.integer("bytesInFlight", l.bytesInFlight, 1, maxExact);
        fields.integer("mergeGapBytes", l.mergeGapBytes, 0, maxExact);
        fields.integer("mergedRequestBytes", l.mergedRequestBytes, 1, maxExact);
    });
}

std::string cameraJson(const Camera& c) {
    return Json{{"projection", projectionNames[static_cast<std::size_t>(c.projection)]},
                {"position", vectorJson(c.position)},
                {"target", vectorJson(c.target)},
                {"up", vectorJson(c.up)},
                {"fovYDegrees", c.fovYDegrees},
                {"orthoHeight", c.orthoHeight}}
        .dump();
}

std::string styleJson(const Style& s) {
    return Json{{"colourMode", colourModeNames[static_cast<std::size_t>(s.colourMode)]},
                {"gradient", gradientNames[static_cast<std::size_t>(s.gradient)]},
                {"intensityRange", rangeJson(s.intensityRange)},
                {"elevationRange", rangeJson(s.elevationRange)},
                {"sizeMode", sizeModeNames[static_cast<std::size_t>(s.sizeMode)]},
                {"sizePixels", s.sizePixels},
                {"sizeWorld", s.sizeWorld},
                {"minSizePixels", s.minSizePixels},
                {"maxSizePixels", s.maxSizePixels},
                {"shape", shapeNames[static_cast<std::size_t>(s.shape)]},
                {"edl",
                 {{"enabled", s.edl.enabled},
                  {"neighbours", s.edl.neighbours},
                  {"radiusPixels", s.edl.radiusPixels},
                  {"strength", s.edl.strength}}},
                {"background", s.background}}
        .dump();
}

std::string limitsJson(const SessionLimits& l) {
    return Json{{"pointBudget", l.pointBudget},
                {"minNodePixels", l.minNodePixels},
                {"cacheBytes", l.cacheBytes},
                {"requestsInFlight", l.requestsInFlight},
                {"bytesInFlight", l.bytesInFlight},
                {"mergeGapBytes", l.mergeGapBytes},
                {"mergedRequestBytes", l.mergedRequestBytes}}
        .dump();
}

std::string frameCountersJson(const FrameCounters& c) {
    return Json{{"nodesKnown", c.nodesKnown},
                {"nodesVisited", c.nodesVisited},
                {"nodesOutsideFrustum", c.nodesOutsideFrustum},
                {"nodesTooSmall", c.nodesTooSmall},
                {"nodesOverBudget", c.nodesOverBudget},
                {"nodesSelected", c.nodesSelected},
                {"nodesWaiting", c.nodesWaiting},
                {"nodesDrawn", c.nodesDrawn},
                {"pointsSelected", c.pointsSelected},
                {"pointsDrawn", c.pointsDrawn},
                {"chunksWaiting", c.chunksWaiting},
                {"passesRun", c.passesRun},
                {"passesSkipped", c.passesSkipped},
                {"complete", c.complete}}
        .dump();
}

std::string sessionCountersJson(const SessionCounters& c) {
    return Json{{"framesDrawn", c.framesDrawn},
                {"framesSkipped", c.framesSkipped},
                {"selectionsRun", c.selectionsRun},
                {"selectionsSkipped", c.selectionsSkipped},
                {"requests", c.requests},
                {"requestsMerged", c.requestsMerged},
                {"requestsFailed", c.requestsFailed},
                {"requestsCancelled", c.requestsCancelled},
                {"bytesRequested", c.bytesRequested},
                {"bytesReceived", c.bytesReceived},
                {"chunksLoaded", c.chunksLoaded},
                {"nodesDecoded", c.nodesDecoded},
                {"pointsDecoded", c.pointsDecoded},
                {"nodesEvicted", c.nodesEvicted},
                {"cacheBytes", c.cacheBytes},
                {"cacheBytesPeak", c.cacheBytesPeak}}
        .dump();
}

std::optional<NamedView> namedViewFromName(std::string_view name) {
    if (name == "top")
        return NamedView::top;
    if (name == "front")
        return NamedView::front;
    if (name == "iso")
        return NamedView::iso;
    return std::nullopt;
}

} // namespace stipple
