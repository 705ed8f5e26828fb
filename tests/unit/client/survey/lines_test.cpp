#include "client/survey/lines.hpp"
#include "client/survey/units.hpp"
#include "tests/unit/client/survey/random_points.hpp"

#include <catch2/catch.hpp>

#include <numbers>

using namespace stipple;
using namespace stipple::survey;
using stipple::test::RandomPlaces;

TEST_CASE("a segment says how far, how far in plan, how much up, and which way") {
    Segment segment = measureSegment({1, 2, 3}, {4, 6, 15});
    CHECK(segment.distance == 13);
    CHECK(segment.horizontal == 5);
    CHECK(segment.vertical == 12);
    CHECK(segment.azimuth.value() == Approx(std::atan2(3, 4) * 180 / std::numbers::pi).epsilon(1e-15));
    CHECK(segment.gradient.value() == Approx(std::atan2(12, 5) * 180 / std::numbers::pi).epsilon(1e-15));
    CHECK(measureSegment({4, 6, 15}, {1, 2, 3}).vertical == -12);
}

TEST_CASE("azimuths count clockwise from north and never reach 360") {
    Vec3d ways[] = {{0, 1, 0},  {1, 1, 0},   {1, 0, 0},  {1, -1, 0},
                    {0, -1, 0}, {-1, -1, 0}, {-1, 0, 0}, {-1, 1, 0}};
    for (int i = 0; i < 8; ++i)
        CHECK(measureSegment({}, ways[i]).azimuth.value() == Approx(45.0 * i).margin(1e-13));
    double nearly = measureSegment({}, {-1e-30, 1, 0}).azimuth.value();
    CHECK(nearly >= 0);
    CHECK(nearly < 360);
    CHECK_FALSE(measureSegment({}, {0, 0, 5}).azimuth);
    CHECK(measureSegment({}, {0, 0, 5}).gradient.value() == 90);
    CHECK_FALSE(measureSegment({7, 7, 7}, {7, 7, 7}).gradient);
    CHECK(measureSegment({}, {3e-200, 4e-200, 0}).distance == Approx(5e-200).epsilon(1e-14));
}

TEST_CASE("a line adds up, open and closed") {
    std::vector<Vec3d> points{{0, 0, 0}, {3, 4, 0}, {3, 4, -2}, {0, 0, 3}};
    Line open = measureLine(points);
    REQUIRE(open.segments.size() == 3);
    CHECK(open.distance == Approx(5 + 2 + std::sqrt(50)));
    CHECK(open.horizontal == 10);
    CHECK(open.vertical == 3);
    CHECK(open.ascent == 5);
    CHECK(open.descent == 2);
    CHECK(open.height() == 5);
    Line closed = measureLine(points, {}, true);
    CHECK(closed.segments.size() == 4);
    CHECK(closed.distance == Approx(5 + 2 + std::sqrt(50) + 3));
    CHECK(closed.ascent == closed.descent);
    CHECK(measureLine({}).segments.empty());
    CHECK(measureLine(std::vector<Vec3d>{{1, 1, 1}}).distance == 0);
    CHECK(measureLine(std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}}, {}, true).segments.size() == 1);
}

TEST_CASE("angles keep their digits near 0 and 180 degrees", "[numerics]") {
    RandomPlaces random(3);
    double worst = 0;
    for (double angle : {1e-9, 1e-6, 0.01, 1.0, 45.0, 90.0, 135.0, 179.0, 179.999999})
        for (int i = 0; i < 100; ++i) {
            Vec3d u = random.unit(), side = normalized(cross(u, random.unit()));
            double radians = angle * std::numbers::pi / 180;
            Vec3d v = u * std::cos(radians) + side * std::sin(radians);
            double found = angleAt({5, 6, 7}, Vec3d{5, 6, 7} + u * random.between(1, 50),
                                   Vec3d{5, 6, 7} + v * random.between(1, 50))
                               .value();
            worst = std::max(worst, std::abs(found - angle));
        }
    CHECK(worst < 2e-12); // of the points' own rounding, 1e-15 of 50 at a distance of 1 and more
    CHECK(angleAt({}, {1, 0, 0}, {-3, 0, 0}).value() == Approx(180));
    CHECK_FALSE(angleAt({1, 1, 1}, {1, 1, 1}, {2, 2, 2}));
}

TEST_CASE("units are those of their definitions") {
    CHECK(convertUnits(1, foot, metre) == 0.3048);
    CHECK(convertUnits(3937, surveyFoot, metre) == Approx(1200).epsilon(1e-15));
    CHECK(convertUnits(1, surveyFoot, foot) - 1 == Approx(2e-6).epsilon(0.01));
    CHECK(convertUnits(43560, foot, metre, 2) == Approx(4046.8564224).epsilon(1e-14)); // an acre
    CHECK(convertUnits(1, metre, foot, 3) == Approx(35.314666721488590).epsilon(1e-14));
}
