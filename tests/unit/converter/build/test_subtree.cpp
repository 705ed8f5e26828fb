#include "converter/build/subtree.hpp"
#include "shared/las/las_reader.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

using namespace stipple;

namespace {
constexpr int cubeBits = 20;

struct Points {
    Schema schema = las::schemaOf(0);
    RowLayout layout{schema, BoxI{{0, 0, 0}, Vec3i{1, 1, 1} * ((std::int64_t{1} << cubeBits) - 1)}};
    RootCube cube;
    PointBatch batch;

    // Every fourth is at the place of another, with other attributes.
    explicit Points(std::size_t count) {
        cube.bits = cubeBits;
        batch.resize(schema, count);
        std::mt19937_64 random(count);
        for (Vec3i& p : batch.positions)
            p = {static_cast<std::int64_t>(random() >> (64 - cubeBits)),
                 static_cast<std::int64_t>(random() >> (64 - cubeBits)),
                 static_cast<std::int64_t>(random() >> (64 - cubeBits))};
        for (std::size_t i = 3; i < count; i += 4)
            batch.positions[i] = batch.positions[i - 1];
        for (Bytes& column : batch.columns)
            for (std::uint8_t& byte : column)
                byte = static_cast<std::uint8_t>(random());
    }

    // The rows in the subtree's order, when they came in `order` and in such parts.
    Bytes sorted(const std::vector<std::uint32_t>& order, const std::vector<std::size_t>& parts) const {
        SubtreeBuffers buffers;
        layout.pack(batch, order, buffers.rows(order.size(), layout.rowBytes()));
        Subtree subtree(layout, cube, NodeKey{}, buffers, parts);
        return Bytes(subtree.rows(), subtree.rows() + subtree.size() * layout.rowBytes());
    }
};

// Points by the child of the root that holds them, the children in this order.
std::vector<std::size_t> partByChild(const Points& points, std::array<int, 8> children,
                                     std::vector<std::uint32_t>& order) {
    std::vector<std::size_t> parts;
    order.clear();
    for (int child : children) {
        std::size_t before = order.size();
        for (std::uint32_t i = 0; i < points.batch.size(); ++i) {
            Vec3i p = points.batch.positions[i];
            if ((p.x >> (cubeBits - 1) | p.y >> (cubeBits - 1) << 1 | p.z >> (cubeBits - 1) << 2) == child)
                order.push_back(i);
        }
        parts.push_back(order.size() - before);
    }
    return parts;
}
} // namespace

TEST_CASE("in whatever parts rows come, a subtree sorts them in the same order", "[build]") {
    for (std::size_t count : {100u, 30000u}) { // parts of few rows, and of many
        Points points(count);
        std::vector<std::uint32_t> order(count);
        std::iota(order.begin(), order.end(), 0u);
        const Bytes expected = points.sorted(order, {count});
        auto position = [&](std::size_t i) {
            return points.layout.position(expected.data() + i * points.layout.rowBytes());
        };
        for (std::size_t i = 1; i < count; ++i) { // z before y before x
            Vec3i a = position(i - 1), b = position(i);
            int top =
                63 - std::countl_zero(static_cast<std::uint64_t>((a.x ^ b.x) | (a.y ^ b.y) | (a.z ^ b.z)));
            bool inOrder = a == b;
            for (int axis : {2, 1, 0})
                if (!inOrder && ((a[axis] ^ b[axis]) >> top & 1) != 0) {
                    inOrder = a[axis] < b[axis];
                    break;
                }
            REQUIRE(inOrder);
        }
        std::vector<std::size_t> parts = partByChild(points, {0, 1, 2, 3, 4, 5, 6, 7}, order);
        CHECK(points.sorted(order, parts) == expected);
        parts = partByChild(points, {5, 0, 7, 2, 1, 6, 4, 3}, order);
        CHECK(points.sorted(order, parts) == expected);
        parts.insert(parts.begin() + 3, 0); // an empty one
        CHECK(points.sorted(order, parts) == expected);
        parts = {count / 3, count / 2, count - count / 3 - count / 2}; // that overlap
        CHECK(points.sorted(order, parts) == expected);
    }
}

TEST_CASE("rows that come in order stay where they are", "[build]") {
    Points points(5000);
    std::vector<std::uint32_t> order(points.batch.size());
    std::iota(order.begin(), order.end(), 0u);
    const Bytes expected = points.sorted(order, {order.size()});
    SubtreeBuffers buffers;
    std::uint8_t* rows = buffers.rows(order.size(), points.layout.rowBytes());
    std::copy(expected.begin(), expected.end(), rows);
    Subtree subtree(points.layout, points.cube, NodeKey{}, buffers, std::array<std::size_t, 2>{2000, 3000});
    CHECK(subtree.rows() == rows);
    CHECK(std::equal(expected.begin(), expected.end(), subtree.rows()));
}
