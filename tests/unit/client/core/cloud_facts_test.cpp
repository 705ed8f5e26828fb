#include "client/core/cloud_facts.hpp"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

using namespace stipple;

namespace {

CloudMetadata someCloud() {
    CloudMetadata metadata;
    metadata.pointCount = 10;
    metadata.crs.name = "WGS 84 / UTM zone 32N";
    metadata.crs.epsg = 32632;
    metadata.crs.proj = "+proj=utm +zone=32 +datum=WGS84 +units=m +no_defs";
    metadata.crs.wkt = "PROJCS[…]";
    metadata.crs.unit = "metre";
    metadata.crs.unitMeters = 1;
    Attribute intensity{"Intensity", AttributeType::u16}, angle{"Scan Angle", AttributeType::i16},
        time{"GPS Time", AttributeType::f64};
    angle.scale = -0.006;
    angle.unit = "deg";
    metadata.schema.attributes = {intensity, angle, time};
    metadata.statistics = {{2, 900, 100, 50, {}}, {-1000, 3000, 500, 10, {}}};
    return metadata;
}

} // namespace

TEST_CASE("facts of a cloud: its system, and what attributes mean") {
    nlohmann::json facts = cloudFactsJson(someCloud());
    CHECK(facts["crs"]["epsg"] == 32632);
    CHECK(facts["crs"]["proj"] == someCloud().crs.proj);
    CHECK(facts["crs"]["geocentric"] == false);
    const nlohmann::json& attributes = facts["attributes"];
    REQUIRE(attributes.size() == 3);
    CHECK(attributes[0]["isWhole"] == true);
    CHECK(attributes[0]["min"] == 2);
    CHECK(attributes[0]["deviation"] == 50);
    // Scaled by less than zero: the least is what the largest stored value means.
    CHECK(attributes[1]["isWhole"] == false);
    CHECK(attributes[1]["unit"] == "deg");
    CHECK(attributes[1]["min"].get<double>() == Approx(-18));
    CHECK(attributes[1]["max"].get<double>() == Approx(6));
    CHECK(attributes[1]["deviation"].get<double>() == Approx(0.06));
    CHECK(attributes[2]["type"] == "float64");
    CHECK(attributes[2]["min"].is_null()); // no statistics
}

TEST_CASE("facts of a cloud without a system, and of a geocentric one") {
    CloudMetadata metadata;
    CHECK(cloudFactsJson(metadata)["crs"]["epsg"].is_null());
    CHECK(cloudFactsJson(metadata)["attributes"].empty());
    metadata.crs.axes = {{"Geocentric X", "geocentricX", "metre", 1}};
    CHECK(isGeocentric(metadata.crs));
}
