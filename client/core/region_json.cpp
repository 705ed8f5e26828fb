#include "client/core/region_json.hpp"

#include "client/core/json_fields.hpp"
#include "shared/geometry/oriented_box.hpp"
#include "shared/select/region_options.hpp"

#include <algorithm>

namespace stipple {

namespace {

using json_fields::FieldReader;
using nlohmann::json;

constexpr double limit = 1e100;
constexpr std::size_t maxCorners = 100'000;

Error wrong(const std::string& path, const std::string& what) {
    return {ErrorCode::invalidArgument, what, path, ""};
}

template <std::size_t N>
Result<std::array<double, N>> numbersFrom(const json& value, const std::string& path) {
    std::array<double, N> numbers{};
    bool fits = value.is_array() && value.size() == N;
    for (std::size_t i = 0; fits && i < N; ++i) {
        fits = value[i].is_number() && std::abs(value[i].get<double>()) <= limit;
        numbers[i] = fits ? value[i].get<double>() : 0;
    }
    return fits ? Result<std::array<double, N>>(numbers) : wrong(path, cat("must be ", N, " numbers"));
}

Status readPlaces(FieldReader& fields, const char* name, std::vector<Point2d>& places) {
    fields.list(name, maxCorners, [&](const json& item, const std::string& path) -> Status {
        STIPPLE_TRY(place, numbersFrom<2>(item, path));
        places.push_back({place[0], place[1]});
        return {};
    });
    return {};
}

Status readBox(const json& value, const std::string& path, PointFilter& filter) {
    FieldReader fields(value, path);
    Vec3d centre, halfSize{-1, -1, -1};
    BoxAxes axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    fields.vector("centre", centre, limit);
    fields.vector("halfSize", halfSize, limit);
    std::size_t count = 0;
    bool given = fields.list("axes", 3, [&](const json& item, const std::string& at) -> Status {
        STIPPLE_TRY(axis, numbersFrom<3>(item, at));
        axes[count++] = {axis[0], axis[1], axis[2]};
        return {};
    });
    STIPPLE_CHECK(fields.finish());
    if (given && count != 3)
        return wrong(path, "'axes' must be three vectors");
    auto box = orientedBox(centre, halfSize * 2, axes, false);
    if (!box)
        return box.error().at(path);
    filter.convex = std::make_shared<const ConvexRegion>(*std::move(box));
    return {};
}

Status makePlan(PointFilter& filter, const std::vector<Point2d>& polygon, const std::vector<Point2d>& line,
                double width, const std::string& path) {
    if (!polygon.empty()) {
        if (polygon.size() < 3)
            return wrong(path, "'polygon' must have three corners at least");
        filter.region = std::make_shared<const PolygonRegion>(std::vector<Polygon>{{Ring(polygon), {}}});
    }
    if (!line.empty()) {
        auto corridor = Corridor::make(line, width);
        if (!corridor)
            return corridor.error().at(path);
        filter.corridor = std::make_shared<const Corridor>(*std::move(corridor));
    }
    return {};
}

} // namespace

Result<ScreenPolygon> screenPolygonFromJson(const json& value, const std::string& path) {
    ScreenPolygon polygon;
    FieldReader fields(value, path);
    if (value.is_object() && value.contains("eye") && !value["eye"].is_null()) {
        Vec3d eye;
        fields.vector("eye", eye, limit);
        polygon.eye = eye;
    } else {
        fields.allow("eye");
    }
    fields.vector("forward", polygon.forward, limit);
    fields.list("corners", maxScreenCorners, [&](const json& item, const std::string& at) -> Status {
        STIPPLE_TRY(corner, numbersFrom<3>(item, at));
        polygon.corners.push_back({corner[0], corner[1], corner[2]});
        return {};
    });
    STIPPLE_CHECK(fields.finish());
    return polygon;
}

json toJson(const ScreenPolygon& polygon) {
    auto list = [](Vec3d v) { return json{v.x, v.y, v.z}; };
    json corners = json::array();
    for (Vec3d corner : polygon.corners)
        corners.push_back(list(corner));
    return {{"eye", polygon.eye ? list(*polygon.eye) : json(nullptr)},
            {"forward", list(polygon.forward)},
            {"corners", std::move(corners)}};
}

Result<PointFilter> regionFromJson(const json& region, const std::string& path) {
    PointFilter filter;
    FieldReader fields(region, path);
    if (!region.is_object())
        return fields.finish().error();
    std::vector<Point2d> polygon, line;
    double width = 0;
    std::array<double, 2> heights{};
    STIPPLE_CHECK(readPlaces(fields, "polygon", polygon));
    STIPPLE_CHECK(readPlaces(fields, "line", line));
    fields.number("width", width, 0, limit);
    if (fields.numbersOf("heights", heights, limit)) {
        if (heights[0] > heights[1])
            return wrong(path, "'heights' must be [low, high] with low <= high");
        limitHeights(filter, {heights[0], heights[1]});
    }
    fields.allow("box");
    fields.allow("prism");
    STIPPLE_CHECK(fields.finish());
    if (auto box = region.find("box"); box != region.end())
        STIPPLE_CHECK(readBox(*box, path + ".box", filter));
    if (auto prism = region.find("prism"); prism != region.end()) {
        STIPPLE_TRY(screen, screenPolygonFromJson(*prism, path + ".prism"));
        auto made = ScreenPrism::make(screen);
        if (!made)
            return made.error().at(path + ".prism");
        filter.prism = std::make_shared<const ScreenPrism>(*std::move(made));
    }
    STIPPLE_CHECK(makePlan(filter, polygon, line, width, path));
    return filter;
}

} // namespace stipple
