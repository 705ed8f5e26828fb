#include "client/bench/camera_path.hpp"
#include "client/core/frustum.hpp"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

using namespace stipple;
using namespace stipple::bench;

namespace {

constexpr BoxD town{{1000, 2000, 50}, {1400, 2300, 90}};

CameraPath made(std::string_view name, const BoxD& content, int frames) {
    auto path = builtInPath(name, content, frames);
    REQUIRE(path.ok());
    REQUIRE(path->cameras.size() == static_cast<std::size_t>(frames));
    return *path;
}

} // namespace

TEST_CASE("every built-in path sees the content in each frame, with cameras of its own") {
    for (std::string_view name : pathNames()) {
        INFO(name);
        CameraPath path = made(name, town, 7);
        for (std::size_t i = 0; i < path.cameras.size(); ++i) {
            REQUIRE(isUsable(path.cameras[i]));
            CHECK(Frustum(viewTransform(path.cameras[i], 160, 90, town)).intersects(town));
            if (i > 0)
                CHECK_FALSE(path.cameras[i] == path.cameras[i - 1]);
        }
        CHECK(made(name, town, 7).cameras == path.cameras);
    }
}

TEST_CASE("paths of a content without a size are usable") {
    for (std::string_view name : pathNames())
        for (BoxD content :
             {BoxD{{5, 5, 5}, {5, 5, 5}}, BoxD{{0, 0, 0}, {10, 0, 0}}, BoxD{{0, 0, 0}, {8, 8, 0}}})
            for (const Camera& camera : made(name, content, 3).cameras) {
                CHECK(isUsable(camera));
                CHECK(length(camera.target - camera.position) > 0);
            }
}

TEST_CASE("paths go where their names say") {
    CameraPath orbit = made("orbit", town, 8);
    Vec3d centre{1200, 2150, 70};
    for (const Camera& camera : orbit.cameras)
        CHECK(length(camera.position - centre) == Approx(length(orbit.cameras[0].position - centre)));
    CHECK(length(orbit.cameras[0].position - orbit.cameras[4].position) > 300); // across
    CameraPath walk = made("walk", town, 4);
    for (const Camera& camera : walk.cameras)
        CHECK(town.contains(camera.position));
    CameraPath dolly = made("dolly", town, 3);
    CHECK(length(dolly.cameras[1].position - centre) ==
          Approx(0.97 * length(dolly.cameras[0].position - centre)));
    CameraPath map = made("map", town, 2);
    CHECK(map.cameras[1].projection == Projection::orthographic);
    CHECK(map.cameras[1].orthoHeight == Approx(0.7 * map.cameras[0].orthoHeight));
    CameraPath over = made("fly-over", town, 2);
    CHECK(over.cameras[0].position.z > 90);
    CHECK(over.cameras[1].position.x > over.cameras[0].position.x + 300);
    CHECK(builtInPath("swim", town, 3).error().code == ErrorCode::invalidArgument);
}

TEST_CASE("paths survive JSON, and what is absent is taken from the camera before") {
    CameraPath path = made("jump", town, 4);
    auto back = pathsFromJson({{"paths", {toJson(path)}}});
    REQUIRE(back.ok());
    REQUIRE(back->size() == 1);
    CHECK(back->front().name == "jump");
    CHECK(back->front().cameras == path.cameras);
    auto json = nlohmann::json::parse(R"({"paths": [{"name": "a", "cameras": [
        {"position": [1, 2, 3], "fovYDegrees": 30}, {"target": [4, 5, 6]}]}]})");
    auto read = pathsFromJson(json);
    REQUIRE(read.ok());
    CHECK(read->front().cameras[1].fovYDegrees == 30);
    CHECK(read->front().cameras[1].position == Vec3d{1, 2, 3});
}

TEST_CASE("wrong camera files are refused") {
    for (const char* text :
         {"[]", "{}", R"({"paths": {}})", R"({"paths": [{"name": "a"}]})",
          R"({"paths": [{"name": "a", "cameras": []}]})", R"({"paths": [{"name": 1, "cameras": [{}]}]})",
          R"({"paths": [{"name": "a", "cameras": [{"fov": 3}]}]})", R"({"paths": [], "more": 1})"}) {
        INFO(text);
        auto read = pathsFromJson(nlohmann::json::parse(text));
        REQUIRE_FALSE(read.ok());
        CHECK(read.error().code == ErrorCode::invalidArgument);
    }
}
