#include "client/core/json.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace stipple;

namespace {

template <class T>
std::string refusal(const Result<T>& result) {
    REQUIRE_FALSE(result.ok());
    CHECK(result.error().code == ErrorCode::invalidArgument);
    return result.error().sentence();
}

} // namespace

TEST_CASE("a camera survives the way to JSON and back, bit by bit") {
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.position = {635589.0123456789, -1e9 / 3, 0.1};
    camera.target = {1.0 / 3, 2, 3};
    camera.fovYDegrees = 33.3;
    camera.orthoHeight = 1e-3;
    auto back = cameraFromJson(jsonText(toJson(camera)));
    REQUIRE(back.ok());
    CHECK(*back == camera);
}

TEST_CASE("a style survives the way to JSON and back") {
    Style style;
    style.colourMode = ColourMode::elevation;
    style.gradient = GradientName::terrain;
    style.elevationRange = {-3, 7.5};
    style.sizeMode = PointSizeMode::world;
    style.splats = {true, 7, 0.25};
    style.delayedExpansion = DelayedExpansion::automatic;
    style.sizeWorld = 0.25;
    style.shape = PointShape::square;
    style.edl = {false, 4, 2.5, 1.25};
    style.background = {1, 2, 255};
    auto back = styleFromJson(jsonText(toJson(style)));
    REQUIRE(back.ok());
    CHECK(*back == style);
}

TEST_CASE("limits survive the way to JSON and back") {
    SessionLimits limits;
    limits.pointBudget = 123;
    limits.cacheBytes = 1ull << 33;
    limits.minNodePixels = 12.5;
    limits.requestsInFlight = 3;
    auto back = limitsFromJson(toJson(limits));
    REQUIRE(back.ok());
    CHECK(toJson(*back) == toJson(limits));
}

TEST_CASE("fields that are absent keep their values") {
    Style base;
    base.sizePixels = 5;
    base.elevationRange = {1, 2};
    auto style = styleFromJson(R"({"edl": {"strength": 1}, "elevationRange": null})", base);
    REQUIRE(style.ok());
    CHECK(style->sizePixels == 5);
    CHECK(style->edl.strength == 1);
    CHECK(style->edl.neighbours == 8);
    CHECK(style->elevationRange == Range{});
}

TEST_CASE("what is wrong is refused by name") {
    CHECK(refusal(styleFromJson(R"({"sizepixels": 3})")).find("no field 'sizepixels'") != std::string::npos);
    CHECK(refusal(styleFromJson(R"({"colourMode": "pink"})")).find("rgb, intensity, elevation") !=
          std::string::npos);
    CHECK(refusal(styleFromJson(R"({"edl": {"neighbours": 6}})")).find("style.edl: 'neighbours'") !=
          std::string::npos);
    CHECK(refusal(styleFromJson(R"({"background": [0, 0, 256]})")).find("'background'") != std::string::npos);
    CHECK(refusal(styleFromJson(R"({"background": [0, 0.5, 1]})")).find("'background'") != std::string::npos);
    CHECK(refusal(styleFromJson(R"({"intensityRange": [2, 1]})")).find("'intensityRange'") !=
          std::string::npos);
    CHECK(refusal(styleFromJson(R"({"minSizePixels": 9, "maxSizePixels": 8})")).find("'minSizePixels'") !=
          std::string::npos);
    CHECK(refusal(cameraFromJson(R"({"position": [1, 2]})")).find("camera: 'position'") != std::string::npos);
    CHECK(refusal(cameraFromJson(R"({"position": [1, 2, "3"]})")).find("'position'") != std::string::npos);
    CHECK(refusal(cameraFromJson(R"({"fovYDegrees": 180})")).find("'fovYDegrees'") != std::string::npos);
    CHECK(refusal(cameraFromJson(R"({"orthoHeight": 0})")).find("'orthoHeight'") != std::string::npos);
    CHECK(refusal(cameraFromJson("[]")).find("camera") != std::string::npos);
    CHECK(refusal(cameraFromJson("{\"position\": ")).find("not valid JSON") != std::string::npos);
    CHECK(refusal(limitsFromJson(R"({"pointBudget": -1})")).find("'pointBudget'") != std::string::npos);
    CHECK(refusal(limitsFromJson(R"({"requestsInFlight": 1.5})")).find("'requestsInFlight'") !=
          std::string::npos);
}

TEST_CASE("a cloud shows its stage, and its error once it failed") {
    CloudState cloud;
    cloud.id = 7;
    cloud.name = "broken \xff name";
    cloud.stage = CloudStage::failed;
    cloud.error = {ErrorCode::changed, "the file is another one now", "town.stipple", "open it again"};
    nlohmann::json value = toJson(cloud);
    CHECK(value["stage"] == "failed");
    CHECK(value["error"]["code"] == errorCodeName(ErrorCode::changed));
    CHECK(value["error"]["sentence"] == cloud.error.sentence());
    CHECK_FALSE(jsonText(value).empty());

    cloud.stage = CloudStage::ready;
    auto metadata = std::make_shared<CloudMetadata>();
    metadata->pointCount = 42;
    metadata->schema.attributes.emplace_back().name = "Intensity";
    cloud.metadata = metadata;
    value = toJson(cloud);
    CHECK_FALSE(value.contains("error"));
    CHECK(value["pointCount"] == 42);
    CHECK(value["bounds"].is_null());
    CHECK(value["attributes"] == nlohmann::json::array({"Intensity"}));
}

TEST_CASE("named views are known by name") {
    CHECK(namedViewFromName("iso") == NamedView::iso);
    CHECK(namedViewFromName("back") == std::nullopt);
}
