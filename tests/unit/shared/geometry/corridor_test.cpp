#include "shared/geometry/corridor.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace stipple;

namespace {

constexpr double pi = 3.14159265358979323846;

Corridor corridor(const std::vector<Point2d>& line, double width) {
    auto made = Corridor::make(line, width);
    if (!made)
        FAIL(made.error().sentence());
    return *std::move(made);
}

// Of all parts, not only those that a box is near to.
std::optional<Corridor::Place> placeOf(const Corridor& c, Point2d p) {
    std::vector<std::uint32_t> parts = c.partsNear({{-1e9, -1e9, 0}, {1e9, 1e9, 0}});
    auto place = c.placeOf(p, parts);
    CHECK(c.contains(p, parts) == place.has_value());
    return place;
}

void checkPlace(const Corridor& c, Point2d p, double station, double offset) {
    auto place = placeOf(c, p);
    REQUIRE(place);
    CHECK(place->station == Approx(station).margin(1e-12));
    CHECK(place->offset == Approx(offset).margin(1e-12));
}

// A line whose segments are longer than what corners take of them, bending by at most 75 degrees.
std::vector<Point2d> gentleLine(std::mt19937_64& random, int points, double width) {
    std::uniform_real_distribution<double> unit(-1, 1);
    double heading = pi * unit(random);
    std::vector<Point2d> line{{100 * unit(random), 100 * unit(random)}};
    for (int i = 1; i < points; ++i) {
        double length = width * (2 + unit(random) / 2);
        line.push_back(
            {line.back().x + length * std::cos(heading), line.back().y + length * std::sin(heading)});
        heading += 75 * pi / 180 * unit(random);
    }
    return line;
}

// Mitred corridors by their other description: each segment's strip from the bisector of one corner to that
// of the next. Answers the number of strips that hold the point; `near` is set if the point is too near an
// edge to tell.
int stripsHolding(const std::vector<Point2d>& line, double width, Point2d p, bool& near) {
    auto unit = [](Point2d a, Point2d b) {
        double size = std::hypot(b.x - a.x, b.y - a.y);
        return Point2d{(b.x - a.x) / size, (b.y - a.y) / size};
    };
    int strips = 0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        Point2d d = unit(line[i], line[i + 1]), first = d, last = d;
        if (i > 0) {
            Point2d before = unit(line[i - 1], line[i]);
            first = {d.x + before.x, d.y + before.y};
        }
        if (i + 2 < line.size()) {
            Point2d after = unit(line[i + 1], line[i + 2]);
            last = {d.x + after.x, d.y + after.y};
        }
        double offset = d.x * (p.y - line[i].y) - d.y * (p.x - line[i].x);
        double sinceFirst = first.x * (p.x - line[i].x) + first.y * (p.y - line[i].y);
        double untilLast = -(last.x * (p.x - line[i + 1].x) + last.y * (p.y - line[i + 1].y));
        double margins[] = {width / 2 - std::abs(offset), sinceFirst, untilLast};
        bool in = true;
        for (double margin : margins) {
            in = in && margin >= 0;
            near = near || std::abs(margin) < 1e-9;
        }
        strips += in;
    }
    return strips;
}

} // namespace

TEST_CASE("a straight corridor is a rectangle with flat ends") {
    Corridor c = corridor({{10, 20}, {40, 60}}, 10); // 50 long
    CHECK(c.length() == 50);
    checkPlace(c, {10, 20}, 0, 0);
    checkPlace(c, {40, 60}, 50, 0);
    checkPlace(c, {25 - 4 * 0.999, 40 + 3 * 0.999}, 25, 4.995);
    checkPlace(c, {25 + 4 * 0.999, 40 - 3 * 0.999}, 25, -4.995);
    CHECK_FALSE(placeOf(c, {25 - 4 * 1.001, 40 + 3 * 1.001}));
    CHECK_FALSE(placeOf(c, {25 + 4 * 1.001, 40 - 3 * 1.001}));
    CHECK_FALSE(placeOf(c, {9.999, 19.999}));
    CHECK_FALSE(placeOf(c, {40.001, 60.001}));
}

TEST_CASE("edges belong to a corridor to the last bit, wherever it lies") {
    for (Point2d at : {Point2d{0, 0}, Point2d{500000.1, 4000000.7}, Point2d{-1e7 / 3, 1e7 / 7}}) {
        Corridor c = corridor({at, {at.x + 100, at.y}}, 10);
        double left = at.y + 5, right = at.y - 5;
        // at.y ± 5 is rounded where at.y is large; the edge itself is not.
        bool leftIn = left - at.y <= 5, rightIn = at.y - right <= 5;
        CHECK(placeOf(c, {at.x + 50, left}).has_value() == leftIn);
        CHECK(placeOf(c, {at.x + 50, right}).has_value() == rightIn);
        CHECK(placeOf(c, {at.x, at.y}));
        CHECK_FALSE(placeOf(c, {std::nextafter(at.x, -1e9), at.y}));
    }
}

TEST_CASE("a corner is filled to the mitre's tip") {
    Corridor c = corridor({{0, 0}, {100, 0}, {100, 100}}, 10); // turns left
    CHECK(c.length() == 200);
    CHECK(placeOf(c, {105, -5})); // the tip
    CHECK_FALSE(placeOf(c, {105.001, -4.9}));
    CHECK_FALSE(placeOf(c, {104.9, -5.001}));
    checkPlace(c, {103, -4}, 100, -5); // 3-4-5: the corner is its nearest place
    checkPlace(c, {100, -4}, 100, -4);
    checkPlace(c, {104, 0}, 100, -4);
    checkPlace(c, {104, 1}, 101, -4);
    // Inside the turn a point belongs to the nearer segment, once.
    checkPlace(c, {96, 1}, 96, 1);
    checkPlace(c, {99, 4}, 104, 1);
    checkPlace(c, {97, 3}, 97, 3); // equally near: to the earlier
    // The other way round, offsets are those of the other side.
    Corridor back = corridor({{100, 100}, {100, 0}, {0, 0}}, 10);
    checkPlace(back, {103, -4}, 100, 5);
    checkPlace(back, {104, 1}, 99, 4);
}

TEST_CASE("very sharp corners are cut between the outer corners of the rectangles") {
    auto turned = [](double degrees) {
        double a = degrees * pi / 180;
        return corridor({{-100, 0}, {0, 0}, {100 * std::cos(a), 100 * std::sin(a)}}, 2);
    };
    // The tip lies 1 / cos(turn / 2) half widths away; outwards is 90 degrees behind half the turn.
    auto outward = [](double degrees, double distance) {
        double a = (degrees / 2 - 90) * pi / 180;
        return Point2d{distance * std::cos(a), distance * std::sin(a)};
    };
    double tip150 = 1 / std::cos(75 * pi / 180), cut152 = std::cos(76 * pi / 180);
    CHECK(placeOf(turned(150), outward(150, tip150 - 1e-6)));
    CHECK_FALSE(placeOf(turned(150), outward(150, tip150 + 1e-6)));
    CHECK(placeOf(turned(152), outward(152, cut152 - 1e-6)));
    CHECK_FALSE(placeOf(turned(152), outward(152, cut152 + 1e-6)));
    CHECK_FALSE(placeOf(turned(180), {0.001, 0})); // straight back: a flat end
    CHECK(placeOf(turned(180), {-0.001, 0}));
}

TEST_CASE("mitred strips and a corridor hold the same points, each point one strip") {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> unit(-1, 1);
    int inside = 0, outside = 0, unclear = 0;
    for (int i = 0; i < 100; ++i) {
        double width = 5;
        std::vector<Point2d> line = gentleLine(random, 4, width);
        Corridor c = corridor(line, width);
        for (int s = 0; s < 500; ++s) {
            Point2d near = line[static_cast<std::size_t>(s) % line.size()];
            Point2d p{near.x + 8 * unit(random), near.y + 8 * unit(random)};
            bool isUnclear = false;
            int strips = stripsHolding(line, width, p, isUnclear);
            if (isUnclear) {
                ++unclear;
                continue;
            }
            INFO("line " << i << ", point " << p.x << ", " << p.y);
            REQUIRE(strips <= 1);
            REQUIRE(placeOf(c, p).has_value() == (strips == 1));
            ++(strips == 1 ? inside : outside);
        }
    }
    CHECK(inside > 10000);
    CHECK(outside > 10000);
    CHECK(unclear < 10);
}

TEST_CASE("a point's place is the foot of its distance from the line") {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 50; ++i) {
        double width = 5;
        std::vector<Point2d> line = gentleLine(random, 5, width);
        Corridor c = corridor(line, width);
        for (int s = 0; s < 200; ++s) {
            Point2d near = line[static_cast<std::size_t>(s) % line.size()];
            Point2d p{near.x + 8 * unit(random), near.y + 8 * unit(random)};
            auto place = placeOf(c, p);
            if (!place)
                continue;
            REQUIRE(place->station >= 0);
            REQUIRE(place->station <= c.length());
            // Walk the station along the line, and the distance from there is the offset.
            double rest = place->station;
            std::size_t segment = 0;
            auto lengthOf = [&](std::size_t k) {
                return std::hypot(line[k + 1].x - line[k].x, line[k + 1].y - line[k].y);
            };
            while (segment + 2 < line.size() && rest > lengthOf(segment))
                rest -= lengthOf(segment++);
            double t = rest / lengthOf(segment);
            Point2d foot{line[segment].x + t * (line[segment + 1].x - line[segment].x),
                         line[segment].y + t * (line[segment + 1].y - line[segment].y)};
            REQUIRE(std::hypot(p.x - foot.x, p.y - foot.y) == Approx(std::abs(place->offset)).margin(1e-9));
        }
    }
}

TEST_CASE("large coordinates alter neither membership nor places") {
    std::mt19937_64 random(6);
    std::uniform_int_distribution<int> step(-400, 400); // quarters
    for (int i = 0; i < 30; ++i) {
        std::vector<Point2d> line, far;
        const double dx = 500000, dy = 0x1p23; // exact in the sum
        for (int k = 0; k < 5; ++k) {
            line.push_back({step(random) / 4.0 + 500 * k, step(random) / 4.0});
            far.push_back({line.back().x + dx, line.back().y + dy});
        }
        Corridor c = corridor(line, 33.25), cFar = corridor(far, 33.25);
        CHECK(c.length() == cFar.length());
        for (int s = 0; s < 500; ++s) {
            Point2d p{step(random) / 4.0 + (s % 5) * 500, step(random) / 4.0};
            auto near = placeOf(c, p), away = placeOf(cFar, {p.x + dx, p.y + dy});
            REQUIRE(near == away);
        }
    }
}

TEST_CASE("a line that crosses or follows itself holds its points once") {
    Corridor cross = corridor({{0, 0}, {100, 0}, {100, 50}, {50, 50}, {50, -50}}, 10);
    checkPlace(cross, {50, 0}, 50, 0); // on both; the earlier
    checkPlace(cross, {52, 1}, 52, 1);
    checkPlace(cross, {51, 2}, 100 + 50 + 50 + 48, 1); // nearer to the later
    Corridor back = corridor({{0, 0}, {100, 0}, {0, 0}}, 10);
    CHECK(back.length() == 200);
    checkPlace(back, {30, 3}, 30, 3);
    CHECK_FALSE(placeOf(back, {101, 0}));
}

TEST_CASE("segments shorter than the width lose no point near the line") {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<Point2d> line{{0, 0}};
    for (int i = 0; i < 40; ++i)
        line.push_back({line.back().x + 0.3 + 0.2 * unit(random), line.back().y + 0.5 * unit(random)});
    Corridor c = corridor(line, 8);
    for (int s = 0; s < 3000; ++s) {
        // Beside a place inside a segment, by less than half the width.
        std::size_t k = static_cast<std::size_t>(s) % (line.size() - 1);
        double t = 0.5 + 0.49 * unit(random), offset = 3.99 * unit(random);
        Point2d d{line[k + 1].x - line[k].x, line[k + 1].y - line[k].y};
        double size = std::hypot(d.x, d.y);
        auto place = placeOf(
            c, {line[k].x + t * d.x - offset * d.y / size, line[k].y + t * d.y + offset * d.x / size});
        REQUIRE(place);
        REQUIRE(std::abs(place->offset) <= std::abs(offset) + 1e-12);
    }
}

TEST_CASE("what is said of a box holds for its points") {
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> unit(-1, 1);
    int whole = 0, none = 0;
    for (int i = 0; i < 100; ++i) {
        std::vector<Point2d> line = gentleLine(random, 6, 6);
        if (i % 3 == 0) // also sharp turns
            line.push_back({line[1].x + unit(random), line[1].y + unit(random)});
        Corridor c = corridor(line, 6);
        for (int b = 0; b < 60; ++b) {
            Point2d near = line[static_cast<std::size_t>(b) % line.size()];
            BoxD box;
            Vec3d corner{near.x + 9 * unit(random), near.y + 9 * unit(random), 0};
            box.extend(corner);
            box.extend(corner + Vec3d{2 * unit(random), 2 * unit(random), 100});
            Overlap overlap = c.overlapOf(box);
            whole += overlap == Overlap::whole;
            none += overlap == Overlap::none;
            std::vector<std::uint32_t> parts = c.partsNear(box);
            REQUIRE(parts.empty() == (overlap == Overlap::none));
            for (int s = 0; s < 20; ++s) {
                Point2d p{box.min.x + (unit(random) + 1) / 2 * (box.max.x - box.min.x),
                          box.min.y + (unit(random) + 1) / 2 * (box.max.y - box.min.y)};
                auto place = placeOf(c, p);
                REQUIRE(c.placeOf(p, parts) == place);
                REQUIRE_FALSE((overlap == Overlap::whole && !place));
                REQUIRE((!place || c.bounds().contains({p.x, p.y, 0})));
            }
        }
    }
    CHECK(whole > 500);
    CHECK(none > 500);
}

TEST_CASE("lines that make no corridor are refused with the reason") {
    auto sentence = [](const std::vector<Point2d>& line, double width) {
        auto made = Corridor::make(line, width);
        REQUIRE_FALSE(made.ok());
        CHECK(made.error().code == ErrorCode::invalidArgument);
        return made.error().sentence();
    };
    CHECK(sentence({{0, 0}}, 1) == "a line has at least two points");
    CHECK(sentence({{0, 0}, {1, 0}, {1, 0}}, 1) == "points 2 and 3 of the line are the same (leave one out)");
    CHECK(sentence({{0, 0}, {1, 0}}, 0) == "the width 0 is no distance (give a number above 0)");
    CHECK(sentence({{0, 0}, {1, 0}}, -1) == "the width -1 is no distance (give a number above 0)");
    CHECK(sentence({{0, 0}, {1, 0}}, INFINITY) == "the width inf is no distance (give a number above 0)");
    CHECK(sentence({{0, 0}, {NAN, 0}}, 1) == "point 2 of the line is out of range");
    CHECK(sentence({{0, 0}, {1e200, 0}}, 1) == "point 2 of the line is out of range");
}
