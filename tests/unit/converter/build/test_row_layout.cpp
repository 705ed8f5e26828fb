#include "converter/build/row_layout.hpp"
#include "shared/las/las_reader.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

using namespace stipple;

namespace {
constexpr std::int64_t lowest = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t highest = std::numeric_limits<std::int64_t>::max();

// Attributes of 1, 2, 4 and 8 bytes, and one of 12.
Schema mixedSchema() {
    Schema schema = las::schemaOf(7);
    Attribute normal;
    normal.name = "normal";
    normal.type = AttributeType::f32;
    normal.components = 3;
    schema.attributes.push_back(normal);
    return schema;
}

std::int64_t between(std::int64_t low, std::int64_t high, std::mt19937_64& random) {
    std::uint64_t extent = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low);
    std::uint64_t step = extent == ~std::uint64_t{0} ? random() : random() % (extent + 1);
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(low) + step);
}

PointBatch pointsIn(const Schema& schema, const BoxI& bounds, std::size_t count) {
    std::mt19937_64 random(count);
    PointBatch batch;
    batch.resize(schema, count);
    for (Vec3i& p : batch.positions)
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = between(bounds.min[axis], bounds.max[axis], random);
    if (count > 1) {
        batch.positions.front() = bounds.min;
        batch.positions.back() = bounds.max;
    }
    for (Bytes& column : batch.columns)
        for (std::uint8_t& byte : column)
            byte = static_cast<std::uint8_t>(random());
    return batch;
}

void checkRoundTrip(const BoxI& bounds, std::size_t positionBytes) {
    const Schema schema = mixedSchema();
    const std::size_t count = 1500; // more than a block of the copying loops, and no multiple of it
    PointBatch points = pointsIn(schema, bounds, count);
    RowLayout layout(schema, bounds);
    CHECK(layout.positionBytes() == positionBytes);
    CHECK(layout.attributeBytes() == schema.bytesPerPoint());
    CHECK(layout.rowBytes() == positionBytes + schema.bytesPerPoint());

    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    Bytes rows(count * layout.rowBytes());
    layout.pack(points, order, rows.data());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint8_t* row = rows.data() + i * layout.rowBytes();
        wrong += layout.holds(points.positions[order[i]]) ? 0 : 1;
        wrong += layout.position(row) == points.positions[order[i]] ? 0 : 1;
        const std::uint8_t* at = layout.attributes(row);
        for (std::size_t a = 0; a < schema.attributes.size(); ++a) {
            std::size_t size = schema.attributes[a].size();
            wrong += std::memcmp(at, points.columns[a].data() + order[i] * size, size) == 0 ? 0 : 1;
            at += size;
        }
    }
    CHECK(wrong == 0);

    // Back again: row i holds point order[i].
    std::vector<std::uint32_t> inverse(count);
    for (std::uint32_t i = 0; i < count; ++i)
        inverse[order[i]] = i;
    PointBatch back;
    layout.gather(rows.data(), inverse, back);
    CHECK(back.positions == points.positions);
    CHECK(back.columns == points.columns);
}
} // namespace

TEST_CASE("rows give back the points that were packed, wherever they lie", "[rows]") {
    constexpr std::int64_t far = std::int64_t{1} << 51, most = std::int64_t{1} << 31;
    checkRoundTrip({{0, 0, 0}, {60000, 40000, 500}}, 12);
    checkRoundTrip({{-most, -most, -most}, {most - 1, most - 1, most - 1}}, 12);
    checkRoundTrip({{far, -far, 7}, {far + 2 * most - 2, -far + 1000, 7}}, 12);
    checkRoundTrip({{0, 0, 0}, {2 * most, 0, 0}}, 24); // one step too wide
    checkRoundTrip({{-far, 0, 0}, {far, 1, 1}}, 24);
    checkRoundTrip({{lowest, lowest, lowest}, {highest, highest, highest}}, 24);
    checkRoundTrip({{lowest, 0, 0}, {lowest, 0, 0}}, 24);
    checkRoundTrip({{0, 0, highest}, {0, 0, highest}}, 24);
}

TEST_CASE("narrow rows hold what lies within 2^31 steps of their middle, and nothing else", "[rows]") {
    const Schema schema = mixedSchema();
    constexpr std::int64_t reach = std::int64_t{1} << 31;
    for (std::int64_t middle : {std::int64_t{0}, std::int64_t{1} << 40, -(std::int64_t{1} << 50)}) {
        RowLayout layout(schema, {{middle, middle, middle}, {middle, middle, middle}});
        for (int axis = 0; axis < 3; ++axis) {
            Vec3i inside{middle, middle, middle}, outside = inside;
            inside[axis] = middle + reach - 1;
            outside[axis] = middle + reach;
            CHECK(layout.holds(inside));
            CHECK_FALSE(layout.holds(outside));
            inside[axis] = middle - reach;
            outside[axis] = middle - reach - 1;
            CHECK(layout.holds(inside));
            CHECK_FALSE(layout.holds(outside));
        }
    }
    RowLayout wide(schema, {{0, 0, 0}, {reach * 4, 0, 0}});
    CHECK(wide.holds({lowest, highest, 0}));
}

TEST_CASE("rows of no points, and of points without attributes, are rows", "[rows]") {
    RowLayout empty(Schema{}, BoxI{});
    CHECK(empty.rowBytes() == 12);
    PointBatch batch;
    batch.resize(Schema{}, 1);
    batch.positions[0] = {1, -2, 3};
    Bytes row(empty.rowBytes());
    empty.pack(batch, std::vector<std::uint32_t>{0}, row.data());
    CHECK(empty.position(row.data()) == Vec3i{1, -2, 3});
    PointBatch none;
    empty.gather(row.data(), {}, none);
    CHECK(none.size() == 0);
}
