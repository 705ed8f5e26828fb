#include "converter/export/geojson.hpp"

#include "converter/export/text_file.hpp"
#include "shared/base/text.hpp"
#include "shared/geometry/exact_sum.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace stipple {

namespace {

using Json = nlohmann::json;

class RegionReader {
  public:
    explicit RegionReader(const std::string& what) : what_(what) {}

    Result<GeoJsonRegion> read(const Json& json) {
        STIPPLE_CHECK(readCrs(json));
        STIPPLE_CHECK(readObject(json, "", 0));
        if (polygons_.empty())
            return fail("", "there is no polygon in it");
        return GeoJsonRegion{std::make_shared<PolygonRegion>(std::move(polygons_)), crs_};
    }

  private:
    Error fail(const std::string& place, std::string what, std::string advice = "") const {
        return {ErrorCode::invalidArgument, std::move(what), place.empty() ? what_ : what_ + ", " + place,
                std::move(advice)};
    }

    static std::string member(const std::string& place, const char* name) {
        return place.empty() ? name : place + "." + name;
    }
    static std::string element(const std::string& place, std::size_t index) {
        return cat(place, "[", index, "]");
    }

    // {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::26910"}}
    Status readCrs(const Json& json) {
        auto crs = json.is_object() ? json.find("crs") : json.end();
        if (!json.is_object() || crs == json.end() || crs->is_null())
            return {};
        if (crs->is_object()) {
            auto properties = crs->find("properties");
            if (properties != crs->end() && properties->is_object()) {
                auto name = properties->find("name");
                if (name != properties->end() && name->is_string()) {
                    crs_ = name->get<std::string>();
                    return {};
                }
            }
        }
        return fail("crs", "a coordinate system has to be given by its name",
                    "write {\"type\": \"name\", \"properties\": {\"name\": \"EPSG:n\"}}, or leave it out");
    }

    Status readObject(const Json& json, const std::string& place, int depth) {
        if (!json.is_object())
            return fail(place, "an object with a \"type\" is expected");
        if (depth > maxGeoJsonDepth)
            return fail(place, cat("collections are nested deeper than ", maxGeoJsonDepth));
        auto typed = json.find("type");
        if (typed == json.end() || !typed->is_string())
            return fail(member(place, "type"), "the type is missing");
        const auto& type = typed->get_ref<const std::string&>();
        if (type == "FeatureCollection")
            return readEach(json, "features", place, depth);
        if (type == "GeometryCollection")
            return readEach(json, "geometries", place, depth);
        if (type == "Feature") {
            auto geometry = json.find("geometry");
            if (geometry == json.end())
                return fail(member(place, "geometry"), "the geometry is missing");
            // A feature may be nowhere (RFC 7946 §3.2).
            return geometry->is_null() ? Status()
                                       : readObject(*geometry, member(place, "geometry"), depth + 1);
        }
        if (type != "Polygon" && type != "MultiPolygon")
            return fail(member(place, "type"), cat("a ", type.substr(0, 40), " has no area"),
                        "give Polygon or MultiPolygon, or collections of them");
        std::string at = member(place, "coordinates");
        auto coordinates = json.find("coordinates");
        if (coordinates == json.end() || !coordinates->is_array())
            return fail(at, "an array of coordinates is expected");
        if (type == "Polygon")
            return readPolygon(*coordinates, at);
        for (std::size_t i = 0; i < coordinates->size(); ++i)
            STIPPLE_CHECK(readPolygon((*coordinates)[i], element(at, i)));
        return {};
    }

    Status readEach(const Json& json, const char* name, const std::string& place, int depth) {
        auto members = json.find(name);
        if (members == json.end() || !members->is_array())
            return fail(member(place, name), "an array is expected");
        for (std::size_t i = 0; i < members->size(); ++i)
            STIPPLE_CHECK(readObject((*members)[i], element(member(place, name), i), depth + 1));
        return {};
    }

    Status readPolygon(const Json& json, const std::string& place) {
        if (!json.is_array())
            return fail(place, "an array of rings is expected");
        std::vector<Ring> rings;
        for (std::size_t i = 0; i < json.size(); ++i) {
            STIPPLE_TRY(points, readRing(json[i], element(place, i)));
            rings.emplace_back(std::move(points));
        }
        if (rings.empty())
            return {};
        Ring outer = std::move(rings.front());
        rings.erase(rings.begin());
        polygons_.push_back({std::move(outer), std::move(rings)});
        return {};
    }

    Result<std::vector<Point2d>> readRing(const Json& json, const std::string& place) const {
        if (!json.is_array())
            return fail(place, "an array of positions is expected");
        std::vector<Point2d> points;
        points.reserve(json.size());
        for (std::size_t i = 0; i < json.size(); ++i) {
            const Json& position = json[i];
            if (!position.is_array() || position.size() < 2)
                return fail(element(place, i), "a position of two numbers is expected");
            for (std::size_t axis = 0; axis < 2; ++axis)
                if (!isCoordinate(position[axis]))
                    return fail(element(element(place, i), axis), "a coordinate is expected");
            points.push_back({position[0].get<double>(), position[1].get<double>()});
        }
        if (points.size() < 4)
            return fail(place, cat("a ring has at least four positions, this one has ", points.size()),
                        "the last position repeats the first");
        if (points.front() != points.back())
            return fail(element(place, points.size() - 1), "the ring is not closed",
                        "the last position repeats the first");
        return points;
    }

    static bool isCoordinate(const Json& json) {
        return json.is_number() && isExactlySummable(json.get<double>());
    }

    const std::string& what_;
    std::vector<Polygon> polygons_;
    std::string crs_;
};

// "line 3, column 14" of a byte counted from 1.
std::string lineAndColumn(std::string_view text, std::size_t byte) {
    text = text.substr(0, std::min(text.size(), byte > 0 ? byte - 1 : 0));
    auto line = std::count(text.begin(), text.end(), '\n') + 1;
    std::size_t start = text.rfind('\n') == std::string_view::npos ? 0 : text.rfind('\n') + 1;
    return cat("line ", line, ", column ", text.size() - start + 1);
}

} // namespace

Result<GeoJsonRegion> parseGeoJson(std::string_view text, const std::string& what) {
    Json json;
    try {
        json = Json::parse(text);
    } catch (const Json::parse_error& error) {
        return Error{ErrorCode::invalidArgument, "this is no JSON",
                     what + ", " + lineAndColumn(text, error.byte), ""};
    } catch (const Json::exception&) { // a number that no double holds
        return Error{ErrorCode::invalidArgument, "a number in it is too large", what, ""};
    }
    return RegionReader(what).read(json);
}

Result<GeoJsonRegion> readGeoJson(const std::string& path) {
    STIPPLE_TRY(text, readTextFile(path, maxGeoJsonBytes, "the polygons take"));
    return parseGeoJson(text, path);
}

} // namespace stipple
