#include "client/core/json/view_json.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

namespace {
std::string refusal(const Status& status) {
    REQUIRE_FALSE(status.ok());
    CHECK(status.error().code == ErrorCode::invalidArgument);
    return status.error().sentence();
}
} // namespace

TEST_CASE("a camera survives the way to JSON and back, bit by bit") {
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.position = {635589.0123456789, -1e9 / 3, 0.1};
    camera.target = {1.0 / 3, 2, 3};
    camera.fovYDegrees = 33.3;
    camera.orthoHeight = 1e-3;
    Camera back;
    REQUIRE(updateCamera(back, cameraJson(camera)).ok());
    CHECK(back == camera);
}

TEST_CASE("a style survives the way to JSON and back") {
    Style style;
    style.colourMode = ColourMode::elevation;
    style.gradient = GradientName::terrain;
    style.elevationRange = {-3, 7.5};
    style.sizeMode = PointSizeMode::world;
    style.sizeWorld = 0.25;
    style.shape = PointShape::square;
    style.edl = {false, 4, 2.5, 1.25};
    style.background = {1, 2, 255};
    Style back;
    REQUIRE(updateStyle(back, styleJson(style)).ok());
    CHECK(back == style);
}

TEST_CASE("limits survive the way to JSON and back") {
    SessionLimits limits;
    limits.pointBudget = 123;
    limits.cacheBytes = 1ull << 33;
    limits.minNodePixels = 12.5;
    limits.requestsInFlight = 3;
    SessionLimits back;
    REQUIRE(updateLimits(back, limitsJson(limits)).ok());
    CHECK(back.pointBudget == 123);
    CHECK(back.cacheBytes == 1ull << 33);
    CHECK(back.minNodePixels == 12.5);
    CHECK(back.requestsInFlight == 3);
}

TEST_CASE("fields that are not named keep their values") {
    Style style;
    style.sizePixels = 5;
    REQUIRE(updateStyle(style, R"({"edl":{"strength":1}})").ok());
    CHECK(style.sizePixels == 5);
    CHECK(style.edl.strength == 1);
    CHECK(style.edl.enabled);
}

TEST_CASE("what is wrong is named, and nothing is changed") {
    Style style;
    const Style before = style;
    CHECK(refusal(updateStyle(style, R"({"sizePixels":3,"shape":"star"})")) ==
          "style: \"shape\" must be one of square, circle");
    CHECK(refusal(updateStyle(style, R"({"sizepixels":3})")) == "style: \"sizepixels\" is not known");
    CHECK(refusal(updateStyle(style, R"({"edl":{"neighbours":5}})")) ==
          "style.edl: \"neighbours\" must be 4 or 8");
    CHECK(refusal(updateStyle(style, R"({"sizePixels":-1})")) ==
          "style: \"sizePixels\" must be between 0.1 and 1024");
    CHECK(refusal(updateStyle(style, R"({"background":[1,2]})")) ==
          "style: \"background\" must be an array of 3 numbers");
    CHECK(style == before);
    for (const char* text : {"", "[]", "{", "null", "{\"edl\":3}", "{\"sizePixels\":\"3\"}"})
        refusal(updateStyle(style, text));
}

TEST_CASE("a camera without a direction is refused") {
    Camera camera;
    CHECK(refusal(updateCamera(camera, R"({"position":[1,1,1],"target":[1,1,1]})")) ==
          "camera: \"target\" must differ from position");
    CHECK(refusal(updateCamera(camera, R"({"position":[0,0,9],"target":[0,0,0]})")) ==
          "camera: \"up\" must not be parallel to the direction of view");
}

TEST_CASE("a count must be a whole number in its range") {
    SessionLimits limits;
    refusal(updateLimits(limits, R"({"pointBudget":0})"));
    refusal(updateLimits(limits, R"({"pointBudget":1.5})"));
    refusal(updateLimits(limits, R"({"pointBudget":1e300})"));
    refusal(updateLimits(limits, R"({"requestsInFlight":-1})"));
}

TEST_CASE("counters name their fields as C++ does") {
    FrameCounters frame;
    frame.pointsDrawn = 7;
    frame.complete = true;
    CHECK(frameCountersJson(frame).find(R"("pointsDrawn":7,"chunksWaiting":0)") != std::string::npos);
    SessionCounters session;
    session.bytesReceived = 1ull << 40;
    CHECK(sessionCountersJson(session).find(R"("bytesReceived":1099511627776)") != std::string::npos);
}
