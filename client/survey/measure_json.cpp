#include "client/survey/measure_json.hpp"

#include "client/survey/areas.hpp"
#include "client/survey/circles.hpp"
#include "client/survey/exact_points.hpp"
#include "client/survey/lines.hpp"
#include "client/survey/picked_points.hpp"
#include "client/survey/uncertainty.hpp"
#include "shared/base/text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace stipple::survey {

namespace {

using nlohmann::json;

constexpr std::size_t maxPoints = maxPickedPoints;

// What is measured, ready for the functions: points as seen from the first.
struct Request {
    std::string kind;
    bool closed = false;
    std::vector<Vec3d> points;
    std::vector<double> deviations;
    Vec3d origin; // world position of the first
    Directions directions;
};

Error wrong(Phrase what) {
    return Error{ErrorCode::invalidArgument, std::move(what), "measurement", ""};
}

Result<Request> requestFrom(const json& object) {
    Request request;
    if (!object.is_object() || !object.contains("kind") || !object["kind"].is_string())
        return wrong(say("kind must be a name: point, distance, height, azimuth, angle, area or circle"));
    request.kind = object["kind"].get<std::string>();
    for (const char* flag : {"closed", "geocentric"})
        if (object.contains(flag) && !object[flag].is_boolean())
            return wrong(say(flag, " must be true or false"));
    request.closed = object.value("closed", false);
    STIPPLE_TRY(picked, pickedPointsFrom(object));
    const std::vector<GridPoint>& points = picked.points;
    request.deviations = picked.deviations;
    request.points = localPoints(points);
    request.origin = points.front().grid.toWorld(points.front().steps);
    if (object.value("geocentric", false))
        request.directions = geocentricDirections(request.origin);
    return request;
}

json number(std::optional<double> value) {
    return value && std::isfinite(*value) ? json(*value) : json(nullptr);
}
json vectorJson(Vec3d v) {
    return {v.x, v.y, v.z};
}

// Puts measure(points) into the answer, and its standard deviation.
void put(json& answer, const Request& request, const char* name, const Measure& measure) {
    answer[name] = number(measure(request.points));
    answer[cat("±", name)] = number(uncertaintyOf(measure, request.points, request.deviations));
}

// The same of an angle of a circle, where 359 and 1 degrees are two apart.
void putTurn(json& answer, const Request& request, const char* name,
             const std::function<std::optional<double>(std::span<const Vec3d>)>& measure) {
    std::optional<double> value = measure(request.points);
    answer[name] = number(value);
    Measure offset = [&](std::span<const Vec3d> points) {
        std::optional<double> here = measure(points);
        return here && value ? std::remainder(*here - *value, 360.0) : 0.0;
    };
    answer[cat("±", name)] =
        value ? number(uncertaintyOf(offset, request.points, request.deviations)) : json(nullptr);
}

Segment segmentOf(const Request& request, std::span<const Vec3d> points) {
    return measureSegment(points[0], points[1], request.directions);
}

json distanceAnswer(const Request& request) {
    auto line = [&request](std::span<const Vec3d> points) {
        return measureLine(points, request.directions, request.closed);
    };
    json answer;
    put(answer, request, "distance", [&](auto points) { return line(points).distance; });
    put(answer, request, "horizontal", [&](auto points) { return line(points).horizontal; });
    put(answer, request, "vertical", [&](auto points) { return line(points).vertical; });
    Line whole = line(request.points);
    answer["ascent"] = whole.ascent;
    answer["descent"] = whole.descent;
    answer["segments"] = json::array();
    for (const Segment& segment : whole.segments)
        answer["segments"].push_back({{"distance", segment.distance},
                                      {"horizontal", segment.horizontal},
                                      {"vertical", segment.vertical},
                                      {"azimuth", number(segment.azimuth)},
                                      {"gradient", number(segment.gradient)}});
    return answer;
}

json heightAnswer(const Request& request) {
    const Directions& directions = request.directions;
    auto [lowest, highest] =
        std::minmax_element(request.points.begin(), request.points.end(),
                            [&](Vec3d a, Vec3d b) { return directions.height(a) < directions.height(b); });
    auto low = static_cast<std::size_t>(lowest - request.points.begin());
    auto high = static_cast<std::size_t>(highest - request.points.begin());
    json answer;
    put(answer, request, "height",
        [&](auto points) { return directions.height(points[high] - points[low]); });
    answer["horizontal"] = measureSegment(*lowest, *highest, directions).horizontal;
    return answer;
}

json azimuthAnswer(const Request& request) {
    json answer;
    putTurn(answer, request, "azimuth", [&](auto points) { return segmentOf(request, points).azimuth; });
    putTurn(answer, request, "gradient", [&](auto points) { return segmentOf(request, points).gradient; });
    put(answer, request, "distance", [&](auto points) { return segmentOf(request, points).distance; });
    put(answer, request, "horizontal", [&](auto points) { return segmentOf(request, points).horizontal; });
    return answer;
}

Result<json> angleAnswer(const Request& request) {
    auto angle = [](std::span<const Vec3d> points) { return angleAt(points[1], points[0], points[2]); };
    if (!angle(request.points))
        return wrong(say("an angle needs three different places, the corner second"));
    json answer;
    putTurn(answer, request, "angle", angle);
    return answer;
}

json areaAnswer(const Request& request) {
    auto area = [&request](std::span<const Vec3d> points) { return measureArea(points, request.directions); };
    json answer;
    put(answer, request, "horizontal", [&](auto points) { return area(points).horizontal; });
    put(answer, request, "inPlane", [&](auto points) { return area(points).inPlane; });
    put(answer, request, "perimeter", [&](auto points) { return area(points).perimeter; });
    Area whole = area(request.points);
    answer["deviation"] = whole.deviation;
    answer["normal"] = vectorJson(whole.plane.normal);
    answer["crosses"] = whole.crosses;
    return answer;
}

Result<json> circleAnswer(const Request& request) {
    STIPPLE_TRY(circle, circleThrough(request.points[0], request.points[1], request.points[2]));
    json answer;
    auto radius = [](std::span<const Vec3d> points) {
        auto moved = circleThrough(points[0], points[1], points[2]);
        return moved.ok() ? moved->radius : std::numeric_limits<double>::infinity();
    };
    put(answer, request, "radius", radius);
    put(answer, request, "diameter", [&](auto points) { return 2 * radius(points); });
    answer["circumference"] = 2 * std::numbers::pi * circle.radius;
    answer["area"] = std::numbers::pi * circle.radius * circle.radius;
    answer["centre"] = vectorJson(request.origin + circle.centre);
    answer["normal"] = vectorJson(circle.normal);
    return answer;
}

struct Kind {
    const char* name;
    std::size_t least, most; // points
};
constexpr std::array<Kind, 7> kinds{{{"point", 1, 1},
                                     {"distance", 2, maxPoints},
                                     {"height", 2, maxPoints},
                                     {"azimuth", 2, 2},
                                     {"angle", 3, 3},
                                     {"area", 3, maxPoints},
                                     {"circle", 3, 3}}};

Phrase pointsNeeded(const Kind& kind, std::size_t count) {
    if (kind.most > kind.least)
        return say(kind.name, " needs ", kind.least, " or more points, not ", count);
    if (kind.least > 1)
        return say(kind.name, " needs ", kind.least, " points, not ", count);
    return say(kind.name, " needs 1 point, not ", count);
}

Result<json> answerTo(const Request& request) {
    const std::string& kind = request.kind;
    if (kind == "point")
        return json{{"position", vectorJson(request.origin)}};
    if (kind == "distance")
        return distanceAnswer(request);
    if (kind == "height")
        return heightAnswer(request);
    if (kind == "azimuth")
        return azimuthAnswer(request);
    if (kind == "angle")
        return angleAnswer(request);
    return kind == "area" ? Result<json>(areaAnswer(request)) : circleAnswer(request);
}

} // namespace

Result<json> measureJson(const json& object) {
    STIPPLE_TRY(request, requestFrom(object));
    auto kind = std::find_if(kinds.begin(), kinds.end(),
                             [&](const Kind& known) { return request.kind == known.name; });
    if (kind == kinds.end())
        return wrong(say("there is no kind ", request.kind,
                         "; kinds are point, distance, height, azimuth, angle, area, circle"));
    std::size_t count = request.points.size();
    if (count < kind->least || count > kind->most)
        return wrong(pointsNeeded(*kind, count));
    STIPPLE_TRY(answer, answerTo(request));
    answer["kind"] = request.kind;
    return answer;
}

} // namespace stipple::survey
