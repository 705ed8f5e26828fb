#include "client/core/navigation.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

namespace {

constexpr int width = 1280, height = 720;
constexpr double radians30 = 0.5235987755982988;

class Numbers {
  public:
    double between(double low, double high) {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return low + (high - low) * (static_cast<double>(state_ >> 11) / 9007199254740992.0);
    }

  private:
    std::uint64_t state_ = 7;
};

const Vec3d places[] = {{0, 0, 0}, {691000.37, 5334000.11, 512.9}, {4178241.53, 856119.97, 4727034.23}};

Camera someCamera(Numbers& numbers, Vec3d place, Projection projection) {
    Camera camera;
    camera.projection = projection;
    camera.target = place + Vec3d{numbers.between(-50, 50), numbers.between(-50, 50), numbers.between(0, 20)};
    camera.position =
        camera.target + Vec3d{numbers.between(-80, 80), numbers.between(-80, 80), numbers.between(20, 90)};
    camera.orthoHeight = numbers.between(5, 200);
    camera.fovYDegrees = numbers.between(20, 100);
    return camera;
}

Vec3d pixelOf(const Camera& camera, Vec3d world) {
    return projectToPixels(viewTransform(camera, width, height, {}), width, height, world);
}
double apart(Vec3d a, Vec3d b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}
// A world point that the camera sees, some way around its target.
Vec3d seenPoint(Numbers& numbers, const Camera& camera) {
    for (;;) {
        Vec3d point =
            camera.target + Vec3d{numbers.between(-20, 20), numbers.between(-20, 20), numbers.between(-5, 5)};
        Vec3d pixel = pixelOf(camera, point);
        if (pixel.z > 1 && pixel.x > 0 && pixel.x < width && pixel.y > 0 && pixel.y < height)
            return point;
    }
}

template <class Check>
void forCameras(const Check& check) {
    Numbers numbers;
    for (Vec3d place : places)
        for (Projection projection : {Projection::perspective, Projection::orthographic})
            for (int i = 0; i < 200; ++i)
                check(numbers, someCamera(numbers, place, projection));
}

} // namespace

TEST_CASE("turning about a point leaves it where it is in the picture", "[numerics]") {
    double worst = 0;
    forCameras([&](Numbers& numbers, const Camera& camera) {
        Vec3d pivot = seenPoint(numbers, camera), before = pixelOf(camera, pivot);
        Camera turned =
            orbitAbout(camera, pivot, numbers.between(-300, 300), numbers.between(-100, 100), height);
        CHECK_FALSE(turned == camera);
        worst = std::max(worst, apart(pixelOf(turned, pivot), before));
        CHECK(length(turned.position - pivot) == Approx(length(camera.position - pivot)).epsilon(1e-9));
    });
    CHECK(worst < 1e-4); // at ECEF a coordinate is rounded to 1e-9, some 1e-6 pixels each
}

TEST_CASE("the ground follows the pointer, and the height stays", "[numerics]") {
    double worst = 0;
    forCameras([&](Numbers& numbers, const Camera& camera) {
        Vec3d grabbed = seenPoint(numbers, camera), at = pixelOf(camera, grabbed);
        double x = at.x + numbers.between(-60, 60), y = at.y + numbers.between(-10, 60);
        Camera dragged = dragGround(camera, grabbed, x, y, width, height);
        worst = std::max(worst, apart(pixelOf(dragged, grabbed), {x, y, 0}));
        CHECK(length((dragged.target - dragged.position) - (camera.target - camera.position)) < 1e-7);
    });
    CHECK(worst < 1e-3);
    Camera camera; // at (0, -10, 0), looking along y
    camera.position.z = camera.target.z = 2;
    Camera along = dragGround(camera, {0, 0, 0}, 640, 600, width, height);
    CHECK(along.position.z == 2);
    CHECK(along.position.y == Approx(-2 / (480 / 720.0 * std::tan(radians30))));
    // Above the horizon there is no ground: across the view.
    Camera above = dragGround(camera, {0, 0, 0}, 640, 100, width, height);
    CHECK(apart(pixelOf(above, {0, 0, 0}), {640, 100, 0}) < 1e-9);
    CHECK(above.position.y == camera.position.y);
    CHECK(length(above.position - camera.position) < 20);
    CHECK(dragGround(camera, {0, -50, 0}, 640, 400, width, height) == camera); // behind
}

TEST_CASE("coming nearer to a point leaves it where it is, and never passes it", "[numerics]") {
    forCameras([&](Numbers& numbers, const Camera& camera) {
        Vec3d point = seenPoint(numbers, camera), before = pixelOf(camera, point);
        Camera near = zoomToPoint(camera, point, 0.5);
        CHECK(apart(pixelOf(near, point), before) < 1e-3);
        for (int i = 0; i < 200; ++i)
            near = zoomToPoint(near, point, 0.5);
        CHECK(isUsable(near));
        CHECK(length(near.target - near.position) > 0);
        CHECK(pixelOf(near, point).z > -1e-6);
    });
    Camera camera;
    CHECK(zoomToPoint(camera, {0, 0, 0}, 0) == camera);
    CHECK(zoomToPoint(camera, {0, 0, 0}, std::nan("")) == camera);
    CHECK(zoomToPoint(camera, {std::nan(""), 0, 0}, 0.5) == camera);
}

TEST_CASE("looking around keeps the place, and the content follows the pointer") {
    Camera camera;
    camera.position = {0, 0, 0};
    camera.target = {0, 10, 0};
    Camera turned = lookAround(camera, 30, 0, height);
    CHECK(turned.position == camera.position);
    CHECK(length(turned.target) == Approx(10));
    Vec3d before = pixelOf(camera, {0, 1000, 0}), after = pixelOf(turned, {0, 1000, 0});
    CHECK(after.x - before.x == Approx(30).epsilon(0.15)); // a picture is flat, a turn is not
    CHECK(after.y == Approx(before.y));
    Camera down = lookAround(camera, 0, 30, height);
    CHECK(pixelOf(down, {0, 1000, 0}).y - before.y == Approx(30).epsilon(0.15));
    Camera up = camera;
    for (int i = 0; i < 100; ++i)
        up = lookAround(up, 0, 500, height); // the poles are not passed
    CHECK(isUsable(up));
    CHECK(std::abs(viewTransform(up, 1, 1, {}).right.z) < 1e-9);
}

TEST_CASE("walking is level, flying is along the view") {
    Camera camera;
    camera.position = {0, 0, 10};
    camera.target = {0, 10, 0};
    Camera walked = walk(camera, {5, 0, 0, true});
    CHECK(length(walked.position - Vec3d{0, 5, 10}) < 1e-12);
    Camera flown = walk(camera, {5, 0, 0, false});
    CHECK(length(flown.position - Vec3d{0, 5 / std::sqrt(2), 10 - 5 / std::sqrt(2)}) < 1e-12);
    Camera aside = walk(camera, {0, 3, 2, true});
    CHECK(length(aside.position - Vec3d{3, 0, 12}) < 1e-12);
    CHECK(walk(camera, {std::nan(""), 0, 0, false}) == camera);
    camera.projection = Projection::orthographic;
    Camera nearer = walk(camera, {5, 0, 0, false});
    CHECK(nearer.orthoHeight < camera.orthoHeight);
    CHECK(nearer.position == camera.position);
}

TEST_CASE("facing a point puts it in the middle, from a part of the distance") {
    forCameras([&](Numbers& numbers, const Camera& camera) {
        Vec3d point = seenPoint(numbers, camera);
        Camera near = facing(camera, point, 0.25);
        CHECK(apart(pixelOf(near, point), {width / 2.0, height / 2.0, 0}) < 1e-3);
        if (camera.projection == Projection::perspective)
            CHECK(pixelOf(near, point).z == Approx(pixelOf(camera, point).z * 0.25).epsilon(1e-6));
        else
            CHECK(near.orthoHeight == Approx(camera.orthoHeight * 0.25));
    });
}

TEST_CASE("a flight begins and ends where it says, draws back over far ways, and does not jump") {
    forCameras([&](Numbers& numbers, const Camera& from) {
        Camera to =
            someCamera(numbers, from.target + Vec3d{numbers.between(-500, 500), 300, 0}, from.projection);
        Flight flight(from, to);
        CHECK(flight.at(0) == from);
        CHECK(flight.at(1) == to);
        CHECK(flight.length() > 0);
        double highest = 0;
        Camera before = from;
        auto widthOf = [](const Camera& camera) { return unitsPerPixel(camera, 1); };
        for (int i = 1; i <= 400; ++i) {
            Camera here = flight.at(i / 400.0);
            REQUIRE(isUsable(here));
            double size = std::max(widthOf(here), widthOf(before));
            // No step is more than 1.5 times the mean speed's share of the path, in pictures' heights.
            CHECK(length(here.target - before.target) / size < 0.02 * (1 + flight.length()));
            CHECK(std::abs(std::log(widthOf(here) / widthOf(before))) < 0.02 * (1 + flight.length()));
            highest = std::max(highest, widthOf(here));
            before = here;
        }
        if (length(to.target - from.target) > 4 * std::max(widthOf(from), widthOf(to)))
            CHECK(highest > std::max(widthOf(from), widthOf(to)));
    });
}

TEST_CASE("flights that only come nearer, only turn, or go nowhere are flights, too") {
    Camera from;
    Camera near = zoomToPoint(from, from.target, 0.001);
    Flight flight(from, near);
    CHECK(length(flight.at(0.5).target - from.target) < 1e-12);
    CHECK(length(flight.at(0.5).position - from.target) == Approx(10 * std::sqrt(0.001)));
    CHECK(Flight(from, from).length() == 0);
    CHECK(Flight(from, from).at(0.5).position.y == Approx(from.position.y));
    Camera behind = from;
    behind.position = {0, 10, 0}; // the opposite direction
    for (double t : {0.1, 0.4, 0.5, 0.6, 0.9})
        CHECK(length(Flight(from, behind).at(t).position) == Approx(10));
    Camera other = withProjection(from, Projection::orthographic);
    CHECK(Flight(from, other).at(1) == other);
    CHECK(Flight(from, other).at(0.5).projection == from.projection);
}
