#include "shared/geometry/polygon.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>

using namespace stipple;

namespace {

struct Lattice {
    std::int64_t x, y;
};

std::int64_t cross(Lattice a, Lattice b, Lattice c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The same question in whole numbers, with a ray upwards instead of to the right.
Ring::Side sideByCounting(const std::vector<Lattice>& ring, Lattice p) {
    bool inside = false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        Lattice a = ring[i], b = ring[(i + 1) % ring.size()];
        bool inBox = p.x >= std::min(a.x, b.x) && p.x <= std::max(a.x, b.x) && p.y >= std::min(a.y, b.y) &&
                     p.y <= std::max(a.y, b.y);
        if (inBox && cross(a, b, p) == 0)
            return Ring::Side::boundary;
        if ((a.x <= p.x) == (b.x <= p.x))
            continue;
        if (a.x > b.x)
            std::swap(a, b);
        inside ^= cross(a, b, p) < 0; // below the edge
    }
    return inside ? Ring::Side::inside : Ring::Side::outside;
}

std::vector<Lattice> randomRing(std::mt19937_64& random, std::size_t corners, std::int64_t extent) {
    std::vector<Lattice> ring(corners);
    for (Lattice& p : ring)
        p = {static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(extent)),
             static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(extent))};
    return ring;
}

// Lattice points as doubles: multiples of `step` from `origin`, exact for the values used here.
struct Placing {
    double origin = 0, step = 1;
    Point2d operator()(Lattice p) const {
        return {origin + step * static_cast<double>(p.x), origin + step * static_cast<double>(p.y)};
    }
    Ring operator()(const std::vector<Lattice>& ring) const {
        std::vector<Point2d> points;
        for (Lattice p : ring)
            points.push_back((*this)(p));
        return Ring(points);
    }
};

PolygonRegion squareWithHole() {
    return PolygonRegion({{Ring({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}}),
                           {Ring({{4, 4}, {6, 4}, {6, 6}, {4, 6}, {4, 4}})}}});
}

} // namespace

TEST_CASE("edges and corners of a polygon and of its holes belong to it") {
    PolygonRegion region = squareWithHole();
    for (Point2d p : {Point2d{0, 0}, {10, 0}, {10, 10}, {0, 10}, {5, 0}, {10, 5}, {5, 10}, {0, 5}})
        CHECK(region.contains(p));
    for (Point2d p : {Point2d{4, 4}, {6, 4}, {6, 6}, {4, 6}, {5, 4}, {6, 5}, {5, 6}, {4, 5}})
        CHECK(region.contains(p));
    CHECK(region.contains({2, 5}));
    CHECK_FALSE(region.contains({5, 5}));
    CHECK_FALSE(region.contains({4 + 0x1p-40, 5}));
    for (Point2d p :
         {Point2d{-0x1p-60, 5}, {10 + 0x1p-40, 5}, {5, -0x1p-60}, {5, 10 + 0x1p-40}, {-1, 0}, {11, 10}})
        CHECK_FALSE(region.contains(p));
}

TEST_CASE("polygons of a region are united, also where they overlap") {
    PolygonRegion region(
        {{Ring({{0, 0}, {4, 0}, {4, 4}, {0, 4}}), {}}, {Ring({{2, 2}, {6, 2}, {6, 6}, {2, 6}}), {}}});
    CHECK(region.contains({1, 1}));
    CHECK(region.contains({3, 3}));
    CHECK(region.contains({5, 5}));
    CHECK_FALSE(region.contains({5, 1}));
    CHECK(region.bounds().max.x == 6);
    // One polygon's hole is no hole in another.
    PolygonRegion filled({squareWithHole().polygons()[0], {Ring({{4, 4}, {6, 4}, {6, 6}, {4, 6}}), {}}});
    CHECK(filled.contains({5, 5}));
}

TEST_CASE("a ring of any shape answers as counting in whole numbers does") {
    std::mt19937_64 random(1);
    for (int i = 0; i < 200; ++i) {
        std::size_t corners = 3 + random() % 30;
        std::vector<Lattice> lattice = randomRing(random, corners, i % 2 == 0 ? 8 : 40);
        // Far from the origin too, where products of coordinates round.
        Placing place = i % 3 == 0 ? Placing{5e6, 0x1p-20} : i % 3 == 1 ? Placing{0, 1} : Placing{-3e5, 0.25};
        Ring ring = place(lattice);
        for (std::int64_t y = -1; y <= 41; ++y)
            for (std::int64_t x = -1; x <= 41; ++x)
                if (ring.sideOf(place(Lattice{x, y})) != sideByCounting(lattice, {x, y}))
                    FAIL("ring " << i << " at " << x << ", " << y);
    }
}

TEST_CASE("a ring of thousands of long edges answers as counting does") {
    std::mt19937_64 random(2);
    std::vector<Lattice> lattice = randomRing(random, 3000, 100000);
    Ring ring = Placing{}(lattice);
    for (int i = 0; i < 2000; ++i) {
        Lattice p = i % 4 == 0 ? lattice[random() % lattice.size()]
                               : Lattice{static_cast<std::int64_t>(random() % 100000),
                                         static_cast<std::int64_t>(random() % 100000)};
        if (ring.sideOf(Placing{}(p)) != sideByCounting(lattice, p))
            FAIL("at " << p.x << ", " << p.y);
    }
}

TEST_CASE("the side of a line is right to the last bit") {
    // Points around (0.5, 0.5), a step of the last bit apart, beside the line y = x.
    Point2d a{12, 12}, b{24, 24};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            Point2d p{0.5 + x * 0x1p-53, 0.5 + y * 0x1p-53};
            int expected = p.y > p.x ? 1 : p.y < p.x ? -1 : 0;
            if (orientation(a, b, p) != expected || orientation(b, a, p) != -expected ||
                orientation(p, a, b) != expected)
                FAIL("at " << x << ", " << y);
        }
    CHECK(orientation({1e100, 1e100}, {-1e100, -1e100}, {1e-100, 0}) == 1);
    CHECK(orientation({1e100, 1e100}, {-1e100, -1e100}, {0, 0}) == 0);
}

TEST_CASE("rings without an inside hold their edges only") {
    Ring line({{0, 0}, {4, 4}, {8, 8}, {0, 0}});
    CHECK(line.sideOf({2, 2}) == Ring::Side::boundary);
    CHECK(line.sideOf({2, 3}) == Ring::Side::outside);
    Ring flat({{0, 1}, {4, 1}, {2, 1}, {0, 1}});
    CHECK(flat.sideOf({3, 1}) == Ring::Side::boundary);
    CHECK(flat.sideOf({5, 1}) == Ring::Side::outside);
    Ring spot({{1, 1}, {1, 1}, {1, 1}, {1, 1}});
    CHECK(spot.sideOf({1, 1}) == Ring::Side::boundary);
    CHECK(spot.sideOf({1, 2}) == Ring::Side::outside);
    CHECK(spot.touches({{0, 0, 0}, {2, 2, 0}}));
    CHECK_FALSE(spot.touches({{2, 2, 0}, {3, 3, 0}}));
}

TEST_CASE("a box that is said to be whole or outside is, point by point") {
    std::mt19937_64 random(3);
    int whole = 0, none = 0, partial = 0;
    for (int i = 0; i < 300; ++i) {
        auto ring = [&](std::size_t corners) { return Placing{}(randomRing(random, corners, 40)); };
        PolygonRegion region({{ring(3 + random() % 4), {ring(3)}}, {ring(4), {}}});
        for (int b = 0; b < 20; ++b) {
            auto x = static_cast<int>(random() % 40), y = static_cast<int>(random() % 40);
            auto w = static_cast<int>(random() % 6), h = static_cast<int>(random() % 6);
            BoxD box{{double(x), double(y), 0}, {double(x + w), double(y + h), 0}};
            Overlap overlap = region.overlapOf(box);
            int inside = 0;
            for (int py = y; py <= y + h; ++py)
                for (int px = x; px <= x + w; ++px)
                    inside += region.contains({double(px), double(py)}) ? 1 : 0;
            int all = (w + 1) * (h + 1);
            CHECK((overlap == Overlap::partial || inside == (overlap == Overlap::whole ? all : 0)));
            (overlap == Overlap::partial ? partial : overlap == Overlap::whole ? whole : none) += 1;
        }
    }
    CHECK(whole > 100);
    CHECK(none > 100);
    CHECK(partial > 100);
}
