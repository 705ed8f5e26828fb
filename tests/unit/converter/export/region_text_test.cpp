#include "converter/export/region_text.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

namespace {

const PolygonRegion& regionOf(const std::string& text) {
    static std::shared_ptr<const PolygonRegion> last;
    auto region = regionFromText(text, "polygon");
    if (!region)
        FAIL(region.error().sentence());
    last = region->region;
    return *last;
}

std::string refusal(const std::string& text) {
    auto region = regionFromText(text, "polygon");
    REQUIRE_FALSE(region.ok());
    CHECK(region.error().code == ErrorCode::invalidArgument);
    return region.error().sentence();
}

} // namespace

TEST_CASE("a polygon is GeoJSON, well-known text or corners") {
    for (const char* text : {R"( {"type": "Polygon", "coordinates": [[[0,0],[10,0],[10,10],[0,10],[0,0]]]})",
                             "POLYGON ((0 0, 10 0, 10 10, 0 10, 0 0))", "polygon((0 0,10 0,10 10,0 10,0 0))",
                             "\nPolygon Z ((0 0 7, 10 0 7, 10 10 7, 0 10 7, 0 0 7))\n",
                             "POLYGON ZM ((0 0 7 8, 10 0 7 8, 10 10 7 8, 0 10 7 8, 0 0 7 8))",
                             "MULTIPOLYGON (((0 0, 10 0, 10 10, 0 10, 0 0)))", "0,0;10,0;10,10;0,10",
                             "0,0;10,0;10,10;0,10;0,0"}) {
        INFO(text);
        const PolygonRegion& region = regionOf(text);
        CHECK(region.polygons().size() == 1);
        CHECK(region.contains({5, 5}));
        CHECK(region.contains({10, 3}));
        CHECK_FALSE(region.contains({10.001, 3}));
    }
}

TEST_CASE("well-known text has holes and several polygons") {
    const PolygonRegion& region =
        regionOf("MULTIPOLYGON (((0 0, 10 0, 10 10, 0 10, 0 0), (4 4, 6 4, 6 6, 4 6, 4 4)), "
                 "((20 0, 3e1 0, 30 1.0E1, 20 0)))");
    CHECK(region.polygons().size() == 2);
    CHECK(region.contains({1, 1}));
    CHECK_FALSE(region.contains({5, 5}));
    CHECK(region.contains({29, 5}));
    CHECK_FALSE(region.contains({15, 5}));
}

TEST_CASE("what is wrong in a polygon is told with its place") {
    CHECK(refusal("POINT (1 2)") ==
          "polygon, character 6: \"POINT\" has no area (give POLYGON or MULTIPOLYGON)");
    CHECK(refusal("POLYGON EMPTY") == "polygon, character 14: there is no polygon in it");
    CHECK(refusal("POLYGON X ((0 0))") == "polygon, character 10: \"X\" is not expected");
    CHECK(refusal("POLYGON ((0 0, 10 0, 0 0))") == "polygon, character 26: a ring has at least four points, "
                                                   "this one has 3 (the last repeats the first)");
    CHECK(refusal("POLYGON ((0 0, 10 0, 10 10, 0 1))") ==
          "polygon, character 33: the ring is not closed (the last point repeats the first)");
    CHECK(refusal("POLYGON ((0 0, 10 x, 10 10, 0 0))") == "polygon, character 19: a coordinate is expected");
    CHECK(refusal("POLYGON ((0 0, 1e200 0, 10 10, 0 0))") ==
          "polygon, character 16: a coordinate is expected");
    CHECK(refusal("POLYGON ((0 0, 10 0, 10 10, 0 0)) x") == "polygon, character 35: there is more behind it");
    CHECK(refusal("1,2;3,4") == "polygon: a polygon has at least three corners, this one has 2");
    CHECK(refusal("1,2;3,4;1,2") == "polygon: a polygon has at least three corners, this one has 2");
    CHECK(refusal("1,2;3,4;5") ==
          "polygon: \"5\" is no point of a line (give GeoJSON, well-known text, or corners as x,y;x,y;…)");
    CHECK(refusal("1,2;3,4;1e200,6") == "polygon: a corner is out of range");
    CHECK(refusal("{}").find("type") != std::string::npos);
    refusal("");
}

TEST_CASE("every prefix of well-known text is refused") {
    std::string text =
        "MULTIPOLYGON (((0 0, 10 0, 10 10, 0 0), (1 1, 2 1, 2 2, 1 1)), ((5 5, 6 5, 6 6, 5 5)))";
    regionOf(text);
    for (std::size_t size = 0; size < text.size(); ++size)
        CHECK_FALSE(regionFromText(text.substr(0, size), "polygon").ok());
}
