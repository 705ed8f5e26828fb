#include "client/survey/measure_json.hpp"

#include <nlohmann/json.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace stipple;
using namespace stipple::survey;
using nlohmann::json;

namespace {

// Points of a UTM grid of millimetres, whose coordinates relative to the grid's offset are `places` in
// metres.
json request(const std::string& kind, const std::vector<std::array<double, 3>>& places, double spacing = 0) {
    json points = json::array();
    for (const auto& p : places)
        points.push_back(
            {{"integers", {std::round(p[0] * 1000), std::round(p[1] * 1000), std::round(p[2] * 1000)}},
             {"scale", {0.001, 0.001, 0.001}},
             {"offset", {691000.37, 5334000.11, 512.9}},
             {"spacing", spacing}});
    return {{"kind", kind}, {"points", points}};
}

json answered(const json& question) {
    auto answer = measureJson(question);
    REQUIRE(answer.ok());
    return *answer;
}

std::string refused(const json& question) {
    auto answer = measureJson(question);
    REQUIRE_FALSE(answer.ok());
    CHECK(answer.error().code == ErrorCode::invalidArgument);
    return answer.error().sentence();
}

} // namespace

TEST_CASE("each kind of measurement answers with its values and their deviations") {
    json distance = answered(request("distance", {{0, 0, 0}, {3, 4, 12}, {3, 4, 0}}, 0.12));
    CHECK(distance["distance"].get<double>() == Approx(25).epsilon(1e-15));
    CHECK(distance["horizontal"].get<double>() == Approx(5).epsilon(1e-15));
    CHECK(distance["vertical"] == 0);
    CHECK(distance["ascent"].get<double>() == Approx(12));
    CHECK(distance["segments"].size() == 2);
    CHECK(distance["segments"][1]["azimuth"].is_null());
    CHECK(distance["segments"][1]["gradient"] == -90);
    // Up and down again: the middle point's height counts twice, its plan once.
    double deviation = 0.12 / std::sqrt(12.0);
    CHECK(distance["±vertical"].get<double>() == Approx(deviation * std::sqrt(2)).epsilon(1e-9));
    CHECK(distance["±distance"].get<double>() > 2 * deviation);

    json height = answered(request("height", {{0, 0, 5}, {3, 4, 1}, {9, 9, 2}}, 0.12));
    CHECK(height["height"].get<double>() == Approx(4));
    CHECK(height["horizontal"].get<double>() == Approx(5));
    CHECK(height["±height"].get<double>() == Approx(deviation * std::sqrt(2)));

    json azimuth = answered(request("azimuth", {{0, 0, 0}, {-0.001, 100, 0}}, 0.12));
    CHECK(azimuth["azimuth"].get<double>() ==
          Approx(360 - 0.001 / 100 * 180 / std::numbers::pi).epsilon(1e-12));
    CHECK(azimuth["±azimuth"].get<double>() ==
          Approx(std::sqrt(2) * deviation / 100 * 180 / std::numbers::pi).epsilon(1e-4));

    json angle = answered(request("angle", {{10, 0, 0}, {0, 0, 0}, {0, 0, 10}}));
    CHECK(angle["angle"].get<double>() == Approx(90));
    CHECK(angle["±angle"] == 0);

    json area = answered(request("area", {{0, 0, 0}, {20, 0, 15}, {20, 10, 15}, {0, 10, 0}}));
    CHECK(area["horizontal"].get<double>() == Approx(200).epsilon(1e-14));
    CHECK(area["inPlane"].get<double>() == Approx(250).epsilon(1e-14));
    CHECK(area["perimeter"].get<double>() == Approx(70));
    CHECK(area["crosses"] == false);

    json circle = answered(request("circle", {{5, 0, 1}, {0, 5, 1}, {-5, 0, 1}}));
    CHECK(circle["radius"].get<double>() == Approx(5).epsilon(1e-14));
    CHECK(circle["centre"][0].get<double>() == Approx(691000.37).epsilon(1e-15));
    CHECK(circle["centre"][2].get<double>() == Approx(513.9).epsilon(1e-15));

    json point = answered(request("point", {{1, 2, 3}}));
    CHECK(point["position"][2].get<double>() == Approx(515.9).epsilon(1e-15));
}

TEST_CASE("geocentric points have the up of their place") {
    // On the equator at longitude 90 degrees: up is +y, north +z, east -x.
    json points = json::array();
    for (auto p : {std::array<double, 3>{0, 0, 0}, {-30, 7, 40}})
        points.push_back({{"integers", {p[0] * 1000, p[1] * 1000, p[2] * 1000}},
                          {"scale", {0.001, 0.001, 0.001}},
                          {"offset", {0, 6378137, 0}}});
    json answer = answered({{"kind", "azimuth"}, {"geocentric", true}, {"points", points}});
    CHECK(answer["azimuth"].get<double>() ==
          Approx(std::atan2(30, 40) * 180 / std::numbers::pi).epsilon(1e-12));
    CHECK(answer["horizontal"].get<double>() == Approx(50).epsilon(1e-12));
    CHECK(answer["gradient"].get<double>() ==
          Approx(std::atan2(7, 50) * 180 / std::numbers::pi).epsilon(1e-12));
}

TEST_CASE("what can't be measured is refused by name") {
    CHECK(refused({{"kind", "weight"}, {"points", request("point", {{0, 0, 0}})["points"]}}).find("weight") !=
          std::string::npos);
    CHECK(refused(request("area", {{0, 0, 0}, {1, 1, 1}})).find("area needs 3 or more points, not 2") !=
          std::string::npos);
    CHECK(refused(request("angle", {{0, 0, 0}, {0, 0, 0}, {1, 1, 1}})).find("angle") != std::string::npos);
    CHECK(refused(request("circle", {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}})).find("circle") != std::string::npos);
    CHECK(refused(json::array()).find("kind") != std::string::npos);
    CHECK(refused({{"kind", "point"}}).find("points") != std::string::npos);
    json half = request("point", {{0, 0, 0}});
    half["points"][0]["integers"][1] = 0.5;
    CHECK(refused(half).find("points[0].integers") != std::string::npos);
    json flat = request("point", {{0, 0, 0}});
    flat["points"][0]["scale"][2] = 0;
    CHECK(refused(flat).find("points[0].scale") != std::string::npos);
    json text = request("point", {{0, 0, 0}});
    text["points"][0]["offset"] = "here";
    CHECK(refused(text).find("points[0].offset") != std::string::npos);
    json spaced = request("point", {{0, 0, 0}}, -1);
    CHECK(refused(spaced).find("spacing") != std::string::npos);
    json closed = request("distance", {{0, 0, 0}, {1, 0, 0}});
    closed["closed"] = "yes";
    CHECK(refused(closed).find("closed") != std::string::npos);
}
