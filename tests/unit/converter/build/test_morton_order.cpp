#include "converter/build/morton_order.hpp"

#include "shared/las/las_reader.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>
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

PointStore randomStore(const Schema& schema, int bits, std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    PointBatch batch;
    batch.resize(schema, count);
    std::int64_t mask = (std::int64_t{1} << bits) - 1;
    for (Vec3i& p : batch.positions)
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = static_cast<std::int64_t>(random()) & mask;
    for (std::size_t i = 0; i + 1 < count; i += 5)
        batch.positions[i + 1] = batch.positions[i]; // duplicates
    for (std::uint8_t& byte : batch.columns[0])
        byte = static_cast<std::uint8_t>(random() % 3);
    PointStore store(schema, count);
    store.put(0, batch);
    return store;
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

TEST_CASE("points are put in Morton order, equal positions by attributes", "[morton]") {
    Schema schema{{{"value", AttributeType::u8}}};
    for (int bits : {1, 4, 12, 21, 22, 40, 52})
        for (int threads : {1, 3}) {
            PointStore store = randomStore(schema, bits, 20000, static_cast<std::uint64_t>(bits));
            auto order = mortonOrder(store, RootCube{{0, 0, 0}, bits}, threads, nullptr);
            REQUIRE(order.ok());
            REQUIRE(order->size() == store.size());
            std::vector<bool> seen(store.size());
            for (std::size_t i = 0; i < order->size(); ++i) {
                seen[(*order)[i]] = true;
                if (i == 0)
                    continue;
                int compared = compareBitwise(store.position((*order)[i - 1]), store.position((*order)[i]));
                REQUIRE(compared <= 0);
                if (compared == 0)
                    REQUIRE(*store.attributes((*order)[i - 1]) <= *store.attributes((*order)[i]));
            }
            CHECK(std::all_of(seen.begin(), seen.end(), [](bool was) { return was; }));
        }
}
