#include "converter/build/morton.hpp"

#include <catch2/catch.hpp>

#include <limits>
#include <random>

using namespace stipple;

namespace {
// The definition, bit by bit from the top: z, y, x.
int compareBitwise(Vec3i a, Vec3i b) {
    for (int bit = 62; bit >= 0; --bit)
        for (int axis = 2; axis >= 0; --axis)
            if (((a[axis] ^ b[axis]) >> bit & 1) != 0)
                return (a[axis] >> bit & 1) != 0 ? 1 : -1;
    return 0;
}
} // namespace

TEST_CASE("comparing by Morton code agrees with comparing bit by bit", "[morton]") {
    std::mt19937_64 random(1);
    for (int i = 0; i < 20000; ++i) {
        Vec3i a, b;
        for (int axis = 0; axis < 3; ++axis) {
            a[axis] = static_cast<std::int64_t>(random() >> (12 + random() % 50));
            b[axis] =
                random() % 4 == 0 ? a[axis] : static_cast<std::int64_t>(random() >> (12 + random() % 50));
        }
        REQUIRE(compareMorton(a, b) == compareBitwise(a, b));
    }
}

TEST_CASE("coordinates below zero go before the others", "[morton]") {
    CHECK(compareMorton({-1, 5, 5}, {0, 5, 5}) < 0);
    CHECK(compareMorton({7, -1, 7}, {7, 0, 0}) < 0);
    CHECK(compareMorton({0, 0, 0}, {0, 0, std::numeric_limits<std::int64_t>::min()}) > 0);
    CHECK(compareMorton({-2, -3, -4}, {-2, -3, -4}) == 0);
    CHECK(compareMorton({-2, 0, 0}, {-1, 0, 0}) < 0);
}
