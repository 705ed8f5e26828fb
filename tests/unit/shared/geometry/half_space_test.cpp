#include "shared/geometry/half_space.hpp"

#include <catch2/catch.hpp>
#include <random>

using namespace stipple;

namespace {

__extension__ typedef __int128 Wide;

// A plane and a point of whole numbers, small enough for 128 bits to tell the side.
struct WholeNumbers {
    std::int64_t normal[3], at[3], p[3], distance;

    HalfSpace side() const {
        return {{double(normal[0]), double(normal[1]), double(normal[2])},
                {double(at[0]), double(at[1]), double(at[2])},
                double(distance)};
    }
    Vec3d point() const { return {double(p[0]), double(p[1]), double(p[2])}; }
    bool holds() const {
        Wide sum = -Wide(distance);
        for (int i = 0; i < 3; ++i)
            sum += Wide(normal[i]) * (Wide(p[i]) - at[i]);
        return sum <= 0;
    }
};

} // namespace

TEST_CASE("the side of a plane is exact where rounding would guess") {
    std::mt19937_64 random(1);
    auto upTo = [&](int bits) {
        auto limit = std::int64_t{1} << bits;
        return std::uniform_int_distribution<std::int64_t>(-limit, limit)(random);
    };
    int held = 0, guessedWrong = 0;
    for (int i = 0; i < 200000; ++i) {
        WholeNumbers q{};
        Wide sum = 0;
        for (int axis = 0; axis < 3; ++axis) {
            q.normal[axis] = upTo(26);
            q.at[axis] = upTo(52);
            q.p[axis] = q.at[axis] + upTo(34); // so the sum fits 63 bits
            sum += Wide(q.normal[axis]) * (Wide(q.p[axis]) - q.at[axis]);
        }
        // As near to the plane as doubles of this size come: the sum rounded, or its neighbours.
        q.distance = static_cast<std::int64_t>(static_cast<double>(sum));
        double next = static_cast<double>(q.distance);
        for (int step = i % 3; step > 0; --step)
            next = std::nextafter(next, i % 5 ? 1e300 : -1e300);
        q.distance = static_cast<std::int64_t>(next);
        if (static_cast<double>(q.distance) != next)
            continue;
        HalfSpace side = q.side();
        Vec3d p = q.point();
        REQUIRE(side.contains(p) == q.holds());
        held += q.holds();
        guessedWrong += (dot(side.normal, p - side.at) <= side.distance) != q.holds();
    }
    CHECK(held > 50000);
    CHECK(guessedWrong > 100); // so the exact way was needed
}

TEST_CASE("a point on the plane belongs to the half-space, its neighbours to one side each") {
    HalfSpace flat{{1, 0, 0}, {500000.1, 0, 0}, 0};
    CHECK(flat.contains({500000.1, 7, 7}));
    CHECK_FALSE(flat.contains({std::nextafter(500000.1, 1e9), 7, 7}));
    CHECK(flat.contains({std::nextafter(500000.1, 0.0), 7, 7}));
}

TEST_CASE("a box is told from its corners") {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> unit(-1, 1);
    int seen[3] = {};
    for (int i = 0; i < 5000; ++i) {
        HalfSpace side{{unit(random), i % 4 ? unit(random) : 0, i % 3 ? unit(random) : 0},
                       {unit(random), unit(random), unit(random)},
                       unit(random)};
        BoxD box;
        for (int c = 0; c < 2; ++c)
            box.extend(Vec3d{unit(random), unit(random), unit(random)});
        int inside = 0;
        for (int c = 0; c < 8; ++c)
            inside += side.contains({c & 1 ? box.max.x : box.min.x, c & 2 ? box.max.y : box.min.y,
                                     c & 4 ? box.max.z : box.min.z});
        Overlap expected = inside == 8 ? Overlap::whole : inside == 0 ? Overlap::none : Overlap::partial;
        REQUIRE(side.overlapOf(box) == expected);
        ++seen[static_cast<int>(expected)];
    }
    for (int count : seen)
        CHECK(count > 500);
}

TEST_CASE("a box without end along an axis is told by the others") {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    HalfSpace side{{1, 0, 0}, {5, 5, 5}, 1};
    CHECK(side.overlapOf({{0, -infinity, -infinity}, {6, infinity, infinity}}) == Overlap::whole);
    CHECK(side.overlapOf({{0, -infinity, -infinity}, {6.5, infinity, infinity}}) == Overlap::partial);
    CHECK(side.overlapOf({{6.5, -infinity, -infinity}, {7, infinity, infinity}}) == Overlap::none);
}
