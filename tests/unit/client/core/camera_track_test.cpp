#include "client/core/camera_track.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>

using namespace stipple;

namespace {

const Vec3d places[] = {
    {0, 0, 0}, {691000.37, 5334000.11, 512.9}, {4178241.53, 856119.97, 4727034.23}, {1e12, -1e12, 1e9}};

Camera looking(Vec3d from, Vec3d to) {
    Camera camera;
    camera.position = from;
    camera.target = to;
    return camera;
}

std::vector<Keyframe> someKeyframes(Vec3d place, unsigned seed, int count = 6) {
    std::mt19937 random(seed);
    auto number = [&](double low, double high) {
        return std::uniform_real_distribution<>(low, high)(random);
    };
    std::vector<Keyframe> keyframes;
    for (int i = 0; i < count; ++i) {
        Vec3d at = place + Vec3d{number(-300, 300), number(-300, 300), number(5, 120)};
        Vec3d seen = place + Vec3d{number(-100, 100), number(-100, 100), number(0, 20)};
        keyframes.push_back({looking(at, seen), number(0.2, 9)});
        keyframes.back().camera.fovYDegrees = number(20, 100);
        keyframes.back().camera.orthoHeight = number(1, 1000);
    }
    return keyframes;
}

CameraTrack trackOf(std::vector<Keyframe> keyframes) {
    Result<CameraTrack> track = CameraTrack::make(std::move(keyframes));
    if (!track.ok())
        FAIL(track.error().sentence());
    return *track;
}

Vec3d forwardOf(const Camera& camera) {
    return viewTransform(camera, 1, 1, {}).forward;
}
double elevationOf(const Camera& camera) {
    return std::asin(std::clamp(forwardOf(camera).z, -1.0, 1.0));
}
// Of the position, by how much it may be rounded.
double rounding(const Camera& camera) {
    return 4 * std::numeric_limits<double>::epsilon() * (1 + length(camera.position));
}

bool isWithin(double value, double a, double b, double slack = 0) {
    return value >= std::min(a, b) - slack && value <= std::max(a, b) + slack;
}

std::string refusal(std::vector<Keyframe> keyframes) {
    Result<CameraTrack> track = CameraTrack::make(std::move(keyframes));
    return track.ok() ? "" : track.error().sentence();
}

} // namespace

TEST_CASE("a camera path passes its keyframes at their times, exactly, and stays at its ends") {
    for (Vec3d place : places) {
        std::vector<Keyframe> keyframes = someKeyframes(place, 3);
        CameraTrack track = trackOf(keyframes);
        double time = 0;
        for (std::size_t i = 0; i < keyframes.size(); ++i) {
            time += i > 0 ? keyframes[i].seconds : 0;
            CHECK(track.at(time) == keyframes[i].camera);
        }
        CHECK(track.duration() == time);
        CHECK(track.at(-1) == keyframes.front().camera);
        CHECK(track.at(time + 1) == keyframes.back().camera);
        CHECK(track.at(std::numeric_limits<double>::quiet_NaN()) == keyframes.front().camera);
    }
    CameraTrack still = trackOf({{looking({0, 0, 5}, {1, 1, 0}), 0}});
    CHECK(still.duration() == 0);
    CHECK(still.at(1) == looking({0, 0, 5}, {1, 1, 0}));
}

TEST_CASE("nothing overshoots: between two keyframes each value stays between theirs") {
    for (Vec3d place : places)
        for (unsigned seed = 1; seed <= 20; ++seed) {
            std::vector<Keyframe> keyframes = someKeyframes(place, seed);
            CameraTrack track = trackOf(keyframes);
            double start = 0;
            for (std::size_t i = 1; i < keyframes.size(); start += keyframes[i].seconds, ++i) {
                const Camera &a = keyframes[i - 1].camera, &b = keyframes[i].camera;
                for (int step = 0; step < 50; ++step) {
                    Camera now = track.at(start + keyframes[i].seconds * step / 50);
                    bool inside = isUsable(now);
                    for (int axis = 0; axis < 3; ++axis)
                        inside &= isWithin(now.position[axis], a.position[axis], b.position[axis]);
                    // The target is the position and a direction, rounded at these coordinates.
                    double slack = 1e-12 + rounding(now) / length(a.target - a.position);
                    inside &= isWithin(elevationOf(now), elevationOf(a), elevationOf(b), 30 * slack);
                    inside &= isWithin(now.fovYDegrees, a.fovYDegrees, b.fovYDegrees);
                    inside &= isWithin(std::log(now.orthoHeight), std::log(a.orthoHeight),
                                       std::log(b.orthoHeight), 1e-14);
                    if (!inside)
                        FAIL("seed " << seed << ", keyframe " << i << ", step " << step);
                }
            }
        }
}

TEST_CASE("the camera moves without jumps of its velocity, and begins and ends at rest") {
    std::vector<Keyframe> keyframes = someKeyframes(places[0], 5);
    CameraTrack track = trackOf(keyframes);
    constexpr double small = 1e-5;
    auto velocity = [&](double time) {
        return (track.at(time + small).position - track.at(time).position) * (1 / small);
    };
    double time = 0, fastest = 0;
    for (int i = 0; i < 1000; ++i)
        fastest = std::max(fastest, length(velocity(track.duration() * i / 1000)));
    CHECK(length(velocity(0)) < 1e-3 * fastest);
    CHECK(length(velocity(track.duration() - small)) < 1e-3 * fastest);
    for (std::size_t i = 1; i + 1 < keyframes.size(); ++i) {
        time += keyframes[i].seconds;
        CHECK(length(velocity(time) - velocity(time - small)) < 1e-3 * fastest);
        Vec3d turned = (forwardOf(track.at(time + small)) - forwardOf(track.at(time))) * (1 / small);
        Vec3d before = (forwardOf(track.at(time)) - forwardOf(track.at(time - small))) * (1 / small);
        CHECK(length(turned - before) < 0.02);
    }
}

TEST_CASE("keyframes on a line give a line, and one that only turns stays in its place") {
    Vec3d along{3, -2, 0.5};
    std::vector<Keyframe> line;
    for (double at : {0.0, 10.0, 11.0, 60.0})
        line.push_back({looking(along * at, along * at + Vec3d{0, 5, -1}), 1 + at / 20});
    CameraTrack straight = trackOf(line);
    Vec3d direction = normalized(along);
    for (int i = 0; i <= 200; ++i) {
        Vec3d at = straight.at(straight.duration() * i / 200).position;
        CHECK(length(at - direction * dot(at, direction)) < 1e-12);
    }

    Vec3d here = places[2];
    CameraTrack turning = trackOf({{looking(here, here + Vec3d{100, 0, 0}), 1},
                                   {looking(here, here + Vec3d{0, 1, 0}), 1},
                                   {looking(here, here + Vec3d{-30, 0, -10}), 1}});
    for (int i = 0; i <= 50; ++i)
        CHECK(turning.at(2.0 * i / 50).position == here);
}

TEST_CASE("headings take the short way round, also across north and over several keyframes") {
    auto towards = [](double degrees) {
        double radians = degrees * 3.14159265358979323846 / 180;
        return looking({0, 0, 10}, {std::sin(radians), std::cos(radians), 9.5});
    };
    CameraTrack across = trackOf({{towards(350), 1}, {towards(10), 1}});
    for (int i = 0; i <= 20; ++i)
        CHECK(forwardOf(across.at(i / 20.0)).y > 0.8);
    // Twice around in steps of 60 degrees: always onwards.
    std::vector<Keyframe> around;
    for (int i = 0; i <= 12; ++i)
        around.push_back({towards(60.0 * i), 1});
    CameraTrack twice = trackOf(around);
    double turned = 0;
    for (int i = 0; i < 1200; ++i) {
        Vec3d a = forwardOf(twice.at(i / 100.0)), b = forwardOf(twice.at((i + 1) / 100.0));
        double step = std::atan2(b.x * a.y - b.y * a.x, a.x * b.x + a.y * b.y);
        CHECK(step > -1e-9);
        turned += step;
    }
    CHECK(turned == Approx(4 * 3.14159265358979323846));
}

TEST_CASE("a view straight down is reached and left upright") {
    Camera top = looking({5, 5, 100}, {5, 5, 0}), low = looking({5, -80, 20}, {5, 5, 0});
    CameraTrack track = trackOf({{low, 1}, {top, 2}, {low, 2}});
    for (int i = 0; i <= 400; ++i) {
        ViewTransform view = viewTransform(track.at(4.0 * i / 400), 1, 1, {});
        CHECK(view.right.x == Approx(1).margin(1e-9)); // east stays on the right
        CHECK(view.up.y >= -1e-9);
    }
    CHECK(track.at(2) == top);
}

TEST_CASE("what is no camera path is refused by a sentence") {
    Camera camera = looking({0, 0, 5}, {1, 1, 0}), flat = camera, nowhere = camera, broken = camera;
    flat.projection = Projection::orthographic;
    nowhere.target = nowhere.position;
    broken.position.x = std::numeric_limits<double>::infinity();
    CHECK(refusal({}).find("1 to 1000 keyframes") != std::string::npos);
    CHECK(refusal(std::vector<Keyframe>(1001, {camera, 1})).find("1 to 1000 keyframes") != std::string::npos);
    CHECK(refusal({{camera, 1}, {flat, 1}}).find("all be perspective, or all orthographic") !=
          std::string::npos);
    CHECK(refusal({{camera, 1}, {nowhere, 1}}).find("looks nowhere") != std::string::npos);
    CHECK(refusal({{broken, 1}}).find("looks nowhere") != std::string::npos);
    CHECK(refusal({{camera, 1}, {camera, 0}}).find("'seconds'") != std::string::npos);
    CHECK(refusal({{camera, 1}, {camera, 1e9}}).find("'seconds'") != std::string::npos);

    auto said = [](const char* text) {
        Result<CameraTrack> track = cameraTrackFromJson(text);
        return track.ok() ? "" : track.error().sentence();
    };
    CHECK(said(R"({"keyframes": [{"camera": {"position": [0, 0, 5]}, "seconds": 1}]})") == "");
    CHECK(said(R"({"keyframes": [{"camera": {"position": [0, 0, 5], "colour": 1}}]})").find("colour") !=
          std::string::npos);
    CHECK(said(R"({"keyframes": [{"speed": 1}]})").find("speed") != std::string::npos);
    CHECK(said(R"({"keyframes": 3})").find("list") != std::string::npos);
    CHECK(said("[]").find("object") != std::string::npos);
}
