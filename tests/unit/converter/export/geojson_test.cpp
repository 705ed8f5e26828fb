#include "converter/export/geojson.hpp"

#include "converter/crs/crs.hpp"
#include "converter/export/polygon_crs.hpp"
#include "shared/base/text.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

namespace {

const std::string square = "[[[0,0],[10,0],[10,10],[0,10],[0,0]]]";
const std::string holed = "[[[0,0],[10,0],[10,10],[0,10],[0,0]],[[4,4],[6,4],[6,6],[4,6],[4,4]]]";

std::string polygon(const std::string& coordinates) {
    return R"({"type":"Polygon","coordinates":)" + coordinates + "}";
}

GeoJsonRegion regionOf(const std::string& text) {
    auto region = parseGeoJson(text, "area.json");
    if (!region)
        FAIL(region.error().sentence());
    return *region;
}

std::string sentenceOf(const std::string& text) {
    auto region = parseGeoJson(text, "area.json");
    REQUIRE_FALSE(region.ok());
    CHECK(region.error().code == ErrorCode::invalidArgument);
    return region.error().sentence();
}

} // namespace

TEST_CASE("a GeoJSON polygon with a hole is a region") {
    GeoJsonRegion read = regionOf(polygon(holed));
    CHECK(read.crs.empty());
    CHECK(read.region->contains({2, 2}));
    CHECK(read.region->contains({4, 5}));
    CHECK_FALSE(read.region->contains({5, 5}));
}

TEST_CASE("features and collections of GeoJSON are united") {
    std::string far = "[[[20,0,99],[30,0,99],[30,10,99],[20,0,99]]]";
    std::string geometries = R"({"type":"GeometryCollection","geometries":[)" + polygon(square) + "," +
                             R"({"type":"MultiPolygon","coordinates":[)" + far + "]}]}";
    std::string feature = R"({"type":"Feature","properties":{"a":[1,{}]},"geometry":)" + geometries + "}";
    std::string nowhere = R"({"type":"Feature","properties":null,"geometry":null})";
    for (const std::string& text :
         {geometries, feature,
          R"({"type":"FeatureCollection","features":[)" + nowhere + "," + feature + "]}"}) {
        GeoJsonRegion read = regionOf(text);
        CHECK(read.region->polygons().size() == 2);
        CHECK(read.region->contains({5, 5}));
        CHECK(read.region->contains({29, 5}));
        CHECK_FALSE(read.region->contains({15, 5}));
    }
}

TEST_CASE("what is wrong in GeoJSON is told with its place") {
    CHECK(sentenceOf("{\n  \"type\": Polygon}") == "area.json, line 2, column 11: this is no JSON");
    CHECK(sentenceOf("").find("line 1, column 1") != std::string::npos);
    CHECK(sentenceOf("[]") == "area.json: an object with a \"type\" is expected");
    CHECK(sentenceOf("{}") == "area.json, type: the type is missing");
    CHECK(
        sentenceOf(R"({"type":"Point","coordinates":[1,2]})").find("area.json, type: a Point has no area") ==
        0);
    CHECK(
        sentenceOf(
            R"({"type":"FeatureCollection","features":[{"type":"Feature","geometry":{"type":"LineString"}}]})")
            .find("area.json, features[0].geometry.type: a LineString has no area") == 0);
    CHECK(sentenceOf(R"({"type":"FeatureCollection"})") == "area.json, features: an array is expected");
    CHECK(sentenceOf(R"({"type":"Feature"})") == "area.json, geometry: the geometry is missing");
    CHECK(sentenceOf(R"({"type":"Polygon"})") ==
          "area.json, coordinates: an array of coordinates is expected");
    CHECK(sentenceOf(polygon("[1]")) == "area.json, coordinates[0]: an array of positions is expected");
    CHECK(sentenceOf(polygon("[[[0,0],[1,0],[0]]]")) ==
          "area.json, coordinates[0][2]: a position of two numbers is expected");
    CHECK(sentenceOf(polygon("[[[0,0],[1,\"x\"]]]")) ==
          "area.json, coordinates[0][1][1]: a coordinate is expected");
    CHECK(sentenceOf(polygon("[[[0,0],[1,1e200]]]")) ==
          "area.json, coordinates[0][1][1]: a coordinate is expected");
    CHECK(sentenceOf(polygon("[[[0,0],[1,1e999]]]")).find("area.json") == 0);
    CHECK(sentenceOf(polygon("[[[0,0],[1,0],[0,0]]]"))
              .find("area.json, coordinates[0]: a ring has at least four positions, this one has 3") == 0);
    CHECK(sentenceOf(R"({"type":"MultiPolygon","coordinates":[)" + square + ",[[[0,0],[1,0],[1,1],[0,1]]]]}")
              .find("area.json, coordinates[1][0][3]: the ring is not closed") == 0);
    CHECK(sentenceOf(R"({"type":"FeatureCollection","features":[]})") ==
          "area.json: there is no polygon in it");
    CHECK(sentenceOf(polygon("[]")) == "area.json: there is no polygon in it");
}

TEST_CASE("collections nested without end are refused") {
    auto nested = [](int depth) {
        std::string text = polygon(square);
        for (int i = 0; i < depth; ++i)
            text = R"({"type":"GeometryCollection","geometries":[)" + text + "]}";
        return text;
    };
    CHECK(regionOf(nested(maxGeoJsonDepth)).region->contains({5, 5}));
    CHECK(sentenceOf(nested(maxGeoJsonDepth + 1)).find("nested deeper") != std::string::npos);
    CHECK(sentenceOf(std::string(1000000, '[')).find("no JSON") != std::string::npos);
    std::string brackets = std::string(1000000, '[') + std::string(1000000, ']');
    CHECK(sentenceOf(polygon(brackets)).find("coordinates[0]") != std::string::npos);
}

TEST_CASE("every prefix of a GeoJSON text is refused") {
    std::string text = R"({"type":"Feature","geometry":)" + polygon(holed) + "}";
    for (std::size_t size = 0; size < text.size(); ++size)
        CHECK_FALSE(parseGeoJson(text.substr(0, size), "area.json").ok());
}

TEST_CASE("polygons in another CRS than the cloud's are refused by name") {
    auto named = [](const std::string& name) {
        return regionOf(R"({"type":"Polygon","crs":{"type":"name","properties":{"name":")" + name +
                        R"("}},"coordinates":)" + square + "}")
            .crs;
    };
    auto utm = crsFromUser("EPSG:26910"), withHeights = crsFromUser("EPSG:26910+5703");
    REQUIRE(utm.ok());
    REQUIRE(withHeights.ok());
    std::vector<std::string> warnings;
    CHECK(checkPolygonCrs(*utm, "", warnings).ok());
    CHECK(checkPolygonCrs(*utm, named("EPSG:26910"), warnings).ok());
    CHECK(checkPolygonCrs(*utm, named("urn:ogc:def:crs:EPSG::26910"), warnings).ok());
    CHECK(checkPolygonCrs(*withHeights, named("EPSG:26910"), warnings).ok());
    CHECK(warnings.empty());
    for (const char* other : {"EPSG:26911", "urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326"}) {
        Status status = checkPolygonCrs(*utm, named(other), warnings);
        REQUIRE_FALSE(status.ok());
        CHECK(status.error().what == cat("the polygons are in ", other, ", but the cloud is in EPSG:26910"));
    }
    CHECK(warnings.empty());
    CHECK(checkPolygonCrs(*utm, named("the town's own"), warnings).ok());
    CHECK(checkPolygonCrs({}, named("EPSG:26910"), warnings).ok());
    CHECK(warnings.size() == 2);
    CHECK(sentenceOf(R"({"type":"Polygon","crs":5,"coordinates":)" + square + "}").find("area.json, crs: ") ==
          0);
}
