#include "shared/select/region_json.hpp"

#include "shared/base/json_fields.hpp"
#include "shared/select/region_options.hpp"

#include <cmath>
#include <limits>

namespace stipple {

namespace {

using json_fields::FieldReader;
using nlohmann::json;

constexpr double limit = 1e100, infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t maxCorners = 100'000;

Error wrong(const std::string& path, Phrase what) {
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
    return fits ? Result<std::array<double, N>>(numbers) : wrong(path, say("must be ", N, " numbers"));
}

using Places = std::vector<Point2d>;

Status addPlace(const json& item, const std::string& path, Places& places) {
    STIPPLE_TRY(place, numbersFrom<2>(item, path));
    places.push_back({place[0], place[1]});
    return {};
}

// Empty where the field is absent, and only there.
Places readPlaces(FieldReader& fields, const char* name) {
    Places places;
    bool given = fields.list(name, maxCorners, [&](const json& item, const std::string& at) {
        return addPlace(item, at, places);
    });
    if (given && places.empty())
        fields.fail(name, say("must not be empty"));
    return places;
}

void readRings(FieldReader& fields, RegionShape& shape) {
    Places outer = readPlaces(fields, "polygon");
    bool hasOuter = !outer.empty();
    if (hasOuter)
        shape.rings.push_back(std::move(outer));
    bool given = fields.list("holes", maxCorners, [&](const json& hole, const std::string& path) -> Status {
        if (!hole.is_array() || hole.size() > maxCorners)
            return wrong(path, say("must be a list of corners"));
        Places& ring = shape.rings.emplace_back();
        for (std::size_t i = 0; i < hole.size(); ++i)
            STIPPLE_CHECK(addPlace(hole[i], cat(path, "[", i, "]"), ring));
        return {};
    });
    if (given && !hasOuter)
        fields.fail("holes", say("can't be given without a polygon"));
}

// [low, high]; null: open.
void readHeights(FieldReader& fields, const json& region, RegionShape& shape) {
    fields.allow("heights");
    auto found = region.find("heights");
    if (found == region.end())
        return;
    std::array<double, 2> ends{-infinity, infinity};
    bool fits = found->is_array() && found->size() == 2;
    for (std::size_t i = 0; fits && i < 2; ++i) {
        const json& end = (*found)[i];
        fits = end.is_null() || (end.is_number() && std::abs(end.get<double>()) <= limit);
        if (fits && !end.is_null())
            ends[i] = end.get<double>();
    }
    if (!fits || ends[0] > ends[1])
        return fields.fail("heights", say("must be [low, high] with low <= high, null where open"));
    shape.heights = ValueRange{ends[0], ends[1]};
}

Result<RegionShape::Box> boxFromJson(const json& value, const std::string& path) {
    FieldReader fields(value, path);
    RegionShape::Box box{{}, {-1, -1, -1}};
    fields.vector("centre", box.centre, limit);
    fields.vector("halfSize", box.halfSize, limit);
    std::size_t count = 0;
    bool given = fields.list("axes", 3, [&](const json& item, const std::string& at) -> Status {
        STIPPLE_TRY(axis, numbersFrom<3>(item, at));
        box.axes[count++] = {axis[0], axis[1], axis[2]};
        return {};
    });
    STIPPLE_CHECK(fields.finish());
    if (given && count != 3)
        return wrong(path, say("'axes' must be three vectors"));
    return box;
}

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

json vectorJson(Vec3d v) {
    return json{v.x, v.y, v.z};
}
json placesJson(const Places& places) {
    json list = json::array();
    for (Point2d place : places)
        list.push_back({place.x, place.y});
    return list;
}
// The part of a filter that a region states, if none is there yet.
template <class Part>
Status addPart(const Part& stated, Part& part, const char* what) {
    if (stated && part)
        return Error{ErrorCode::invalidArgument, say("there is another ", what), "",
                     say("give one of the two")};
    if (stated)
        part = stated;
    return {};
}

json endJson(double end) {
    return std::isfinite(end) ? json(end) : json(nullptr);
}

} // namespace

json toJson(const ScreenPolygon& polygon) {
    json corners = json::array();
    for (Vec3d corner : polygon.corners)
        corners.push_back(vectorJson(corner));
    return {{"eye", polygon.eye ? vectorJson(*polygon.eye) : json(nullptr)},
            {"forward", vectorJson(polygon.forward)},
            {"corners", std::move(corners)}};
}

json toJson(const RegionShape& shape) {
    json region = json::object();
    if (const auto& box = shape.box)
        region["box"] = {{"centre", vectorJson(box->centre)},
                         {"halfSize", vectorJson(box->halfSize)},
                         {"axes", json::array({vectorJson(box->axes[0]), vectorJson(box->axes[1]),
                                               vectorJson(box->axes[2])})}};
    if (!shape.rings.empty())
        region["polygon"] = placesJson(shape.rings[0]);
    for (std::size_t hole = 1; hole < shape.rings.size(); ++hole)
        region["holes"].push_back(placesJson(shape.rings[hole]));
    if (!shape.line.empty()) {
        region["line"] = placesJson(shape.line);
        region["width"] = shape.width;
    }
    if (shape.prism)
        region["prism"] = toJson(*shape.prism);
    if (shape.heights)
        region["heights"] = json::array({endJson(shape.heights->min), endJson(shape.heights->max)});
    return region;
}

Result<RegionShape> shapeFromJson(const json& region, const std::string& path) {
    RegionShape shape;
    FieldReader fields(region, path);
    if (!region.is_object())
        return fields.finish().error();
    readRings(fields, shape);
    shape.line = readPlaces(fields, "line");
    fields.number("width", shape.width, 0, limit);
    readHeights(fields, region, shape);
    fields.allow("box");
    fields.allow("prism");
    STIPPLE_CHECK(fields.finish());
    if (auto box = region.find("box"); box != region.end()) {
        STIPPLE_TRY(read, boxFromJson(*box, path + ".box"));
        shape.box = read;
    }
    if (auto prism = region.find("prism"); prism != region.end()) {
        STIPPLE_TRY(read, screenPolygonFromJson(*prism, path + ".prism"));
        shape.prism = std::move(read);
    }
    return shape;
}

Error inRegion(const std::string& path, const Error& error) {
    Error placed = error;
    placed.where = error.where.empty() ? path : path + "." + error.where;
    return placed;
}

Result<PointFilter> regionFromJson(const json& region, const std::string& path) {
    STIPPLE_TRY(shape, shapeFromJson(region, path));
    auto filter = filterOf(shape);
    return filter ? std::move(filter) : Result<PointFilter>(inRegion(path, filter.error()));
}

Status addRegion(PointFilter& filter, std::string_view text) {
    json region = json::parse(text, nullptr, false);
    if (region.is_discarded())
        return Error{ErrorCode::invalidArgument, say("it is no JSON"), "", ""};
    const std::string path = "region";
    auto stated = regionFromJson(region, path);
    if (!stated) {
        Error error = stated.error();
        error.where = error.where.size() > path.size() ? error.where.substr(path.size() + 1) : "";
        return error;
    }
    STIPPLE_CHECK(addPart(stated->convex, filter.convex, "turned box"));
    STIPPLE_CHECK(addPart(stated->region, filter.region, "polygon"));
    STIPPLE_CHECK(addPart(stated->corridor, filter.corridor, "line"));
    STIPPLE_CHECK(addPart(stated->prism, filter.prism, "prism"));
    if (!stated->box)
        return {};
    limitHeights(filter, {stated->box->min.z, stated->box->max.z});
    if (filter.box->min.z > filter.box->max.z)
        return Error{ErrorCode::invalidArgument, say("no height is left"), "", ""};
    return {};
}

} // namespace stipple
