// tests/oracles/lonlat.json holds longitudes and latitudes by PROJ: what the page's projections are compared
// with (tests/e2e/map.test.mjs). Here the file is compared with PROJ itself.
#include "converter/crs/crs.hpp"
#include "converter/crs/transformation.hpp"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <fstream>
#include <iostream>

using namespace stipple;
using nlohmann::json;

namespace {

// What PROJ says of the systems and places of the file.
json byProj(const json& known) {
    json systems = json::array();
    Result<Crs> wgs84 = crsFromUser("EPSG:4326");
    REQUIRE(wgs84.ok());
    for (const json& system : known) {
        Result<Crs> crs = crsFromUser(system["user"].get<std::string>());
        REQUIRE(crs.ok());
        auto transformation = CrsTransformation::create(*crs, *wgs84, {});
        REQUIRE(transformation.ok());
        auto transformer = (*transformation)->transformer();
        REQUIRE(transformer.ok());
        json made{{"user", system["user"]}, {"name", crs->name}, {"proj", crs->proj},
                  {"wkt", crs->wkt},        {"unit", crs->unit}, {"places", json::array()}};
        for (const json& place : system["places"]) {
            auto [x, y, z] = place["place"].get<std::array<double, 3>>();
            json one{{"place", {x, y, z}}};
            (*transformer)->transform(&x, &y, &z, 1);
            one["lonLat"] = {x, y};
            made["places"].push_back(one);
        }
        systems.push_back(made);
    }
    return systems;
}

} // namespace

TEST_CASE("the oracle of longitudes and latitudes is what PROJ says") {
    std::ifstream file(std::string(STIPPLE_SOURCE_DIR) + "/tests/oracles/lonlat.json");
    REQUIRE(file.is_open());
    json known = json::parse(file), now = byProj(known);
    bool same = known.size() == now.size();
    for (std::size_t s = 0; same && s < known.size(); ++s) {
        same = known[s].value("proj", "") == now[s]["proj"] && known[s].value("wkt", "") == now[s]["wkt"];
        for (std::size_t p = 0; same && p < known[s]["places"].size(); ++p)
            for (std::size_t axis = 0; same && axis < 2; ++axis) {
                const json& before = known[s]["places"][p];
                same = before.contains("lonLat") &&
                       std::abs(before["lonLat"][axis].get<double>() -
                                now[s]["places"][p]["lonLat"][axis].get<double>()) < 1e-11;
            }
    }
    if (!same)
        std::cout << "PROJ says now:\n" << now.dump(1) << "\n"; // as it stands: to be kept as the file
    CHECK(same);
}
