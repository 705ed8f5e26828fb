#include "tests/bench/flight.hpp"

#include "tests/support/small_cloud.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <fstream>

using namespace stipple;
using namespace stipple::test;

namespace {

constexpr int width = 160, height = 90;

FlightScene sceneOf(std::string_view flight) {
    static SmallCloud cloud = makeSmallCloud({.levels = 4, .pointsPerNode = 3000});
    TemporaryFolder folder;
    std::string path = folder.file("cloud.stipple");
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(cloud.file.data()),
               static_cast<std::streamsize>(cloud.file.size()));
    FlightScene scene;
    scene.name = flight;
    auto file = std::make_shared<HostedFile>();
    file->bytes = cloud.file;
    scene.file = file;
    scene.width = width;
    scene.height = height;
    auto cameras = flightCameras(flight, cloud.metadata.worldBounds(), 1, 16.0 / 9);
    REQUIRE(cameras.ok());
    scene.cameras = *cameras;
    scene.samples = {29, 59, 89};
    auto targets = targetPictures(path, {scene.cameras[29], scene.cameras[59]}, width, height);
    REQUIRE(targets.ok());
    scene.targets = {(*targets)[0], (*targets)[1], (*targets)[1]};
    return scene;
}

StreamingWay everything() {
    StreamingWay way{"all", {}, {}};
    way.style.detail.mode = DetailMode::continuous; // near, more is wanted
    return way;
}

NetworkOptions slow() {
    NetworkOptions options;
    options.megabitsPerSecond = 8;
    return options;
}

} // namespace

TEST_CASE("a flight is a camera a frame from its first to its last moment, and each name is one") {
    BoxD box{{0, 0, 0}, {100, 80, 20}};
    for (std::string_view name : flightNames()) {
        INFO(name);
        auto cameras = flightCameras(name, box, 2, 1.5);
        REQUIRE(cameras.ok());
        CHECK(cameras->size() == 120);
        CHECK(std::all_of(cameras->begin(), cameras->end(), isUsable));
        CHECK_FALSE(cameras->front() == cameras->back());
    }
    auto wild = *flightCameras("wild", box, 2, 1.5);
    CHECK(wild[0] == wild[2]); // 40 ms are two and a half frames
    CHECK_FALSE(wild[2] == wild[3]);
    auto wheel = *flightCameras("wheel", box, 2, 1.5);
    CHECK(wheel[0] == wheel[4]); // steps at 80, 160, 240 ms, then after 1.2 s
    CHECK_FALSE(wheel[4] == wheel[5]);
    CHECK(wheel[15] == wheel[71]);
    CHECK_FALSE(wheel[71] == wheel[72]);
    CHECK(flightCameras("swim", box, 2, 1.5).error().sentence().find("swim") != std::string::npos);
}

TEST_CASE("a flight errs on its way, less at rest, fetches nothing twice and returns for nothing") {
    std::string flight = GENERATE("fly-over", "walk", "wild", "wheel");
    INFO(flight);
    FlightScene scene = sceneOf(flight);
    auto flown = fly(scene, everything(), slow());
    REQUIRE(flown.ok());
    CHECK(flown->flyingError > 0);
    CHECK(flown->restError <= flown->flyingError);
    CHECK(flown->restSeconds > 0);
    CHECK(flown->network.bytesCarried > 0);
    CHECK(flown->session.bytesFetchedTwice == 0);
    CHECK(flown->returnRequests == 0);

    auto again = fly(scene, everything(), slow());
    REQUIRE(again.ok());
    CHECK(again->flyingError == flown->flyingError);
    CHECK(again->restError == flown->restError);
    CHECK(again->restSeconds == flown->restSeconds);
    CHECK(again->network.bytesCarried == flown->network.bytesCarried);
    CHECK(again->network.requests == flown->network.requests);
}
