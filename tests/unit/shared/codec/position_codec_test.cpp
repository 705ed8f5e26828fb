#include "shared/codec/position_codec.hpp"
#include "shared/codec/progressive_order.hpp"
#include "tests/unit/shared/codec/damage.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>

using namespace stipple;
using namespace stipple::test;

namespace {

using Points = std::vector<Vec3<std::uint32_t>>;

struct Shape {
    const char* name;
    int nodeBits;
    Points points;
};

std::vector<Shape> shapes() {
    std::mt19937 random(11);
    auto below = [&](std::uint32_t limit) { return static_cast<std::uint32_t>(random() % limit); };
    std::vector<Shape> all;
    auto shape = [&](const char* name, int nodeBits, int count, auto make) {
        Points points;
        for (int i = 0; i < count; ++i)
            points.push_back(make(i));
        all.push_back({name, nodeBits, points});
    };
    using P = Vec3<std::uint32_t>;
    constexpr std::uint32_t widest = (1u << 31) - 1;
    shape("one point", 31, 1, [&](int) { return P{widest, 0, widest}; });
    shape("two points", 31, 2, [&](int i) { return P{i == 0 ? widest : 0, 5, widest}; });
    shape("a node of one step", 0, 9, [&](int) { return P{0, 0, 0}; });
    shape("random, 31 bits", 31, 5000, [&](int) {
        return P{below(1u << 31), below(1u << 31), below(1u << 31)};
    });
    shape("few corners, 31 bits", 31, 100, [&](int) {
        return P{below(2) * widest, below(2) * widest, below(2) * widest};
    });
    shape("random, 20 bits", 20, 5001, [&](int) {
        return P{below(1u << 20), below(1u << 20), below(1u << 20)};
    });
    shape("clusters", 24, 5003, [&](int i) {
        auto c = static_cast<std::uint32_t>(i % 7) * 1500000;
        return P{c + below(400), c / 2 + below(90), c / 3 + below(50)};
    });
    shape("a plane", 20, 4999, [&](int) {
        std::uint32_t x = below(1u << 20), y = below(1u << 20);
        return P{x, y, 500000 + x / 5000 + y / 9000};
    });
    shape("an upright plane", 20, 3000, [&](int) { return P{7, below(1u << 20), below(1u << 20)}; });
    shape("equal points", 20, 5000, [&](int) { return P{77, 88, 99}; });
    shape("half equal", 20, 5000, [&](int i) {
        return i % 2 ? P{77, 88, 99} : P{below(100), below(100), 99};
    });
    shape("multiples of a thousand", 24, 2000, [&](int) {
        return P{3 + 1000 * below(9000), 1000 * below(9000), 7};
    });
    return all;
}

Bytes encode(const SortedPoints& sorted, int strata) {
    ByteWriter to;
    auto count = static_cast<std::uint32_t>(sorted.keys.size());
    for (int s = 0; s < strata; ++s)
        if (stratumPoints(count, s) > 0)
            encodePositions(to, sorted, s);
    return to.take();
}

Result<Points> decode(ByteSpan bytes, std::uint32_t count, int nodeBits, int strata) {
    PositionDecoder decoder(count, nodeBits, strata);
    ByteReader from(bytes);
    for (int s = 0; s < strata; ++s)
        if (stratumPoints(count, s) > 0)
            STIPPLE_CHECK(decoder.decode(s, from));
    return decoder.takePositions();
}

} // namespace

TEST_CASE("positions of every shape come back in progressive order, for each prefix of strata") {
    for (const Shape& shape : shapes()) {
        INFO(shape.name);
        auto count = static_cast<std::uint32_t>(shape.points.size());
        SortedPoints sorted = sortPoints(shape.points);
        auto order = progressiveOrder(count);
        for (int strata = 1; strata <= strataCount; ++strata) {
            auto read = decode(encode(sorted, strata), count, shape.nodeBits, strata);
            if (!read)
                FAIL(read.error().sentence());
            REQUIRE(read->size() == strataPrefixPoints(count, strata));
            bool equal = true;
            for (std::size_t r = 0; r < read->size(); ++r)
                equal = equal && (*read)[r] == shape.points[sorted.input[order[r]]];
            CHECK(equal);
        }
    }
}

TEST_CASE("the decoder knows which neighbour is nearer, as the encoder does") {
    Points points = shapes()[6].points;
    auto count = static_cast<std::uint32_t>(points.size());
    SortedPoints sorted = sortPoints(points);
    PositionDecoder decoder(count, 24, strataCount);
    Bytes bytes = encode(sorted, strataCount);
    ByteReader from(bytes);
    for (int s = 0; s < strataCount; ++s) {
        REQUIRE(decoder.decode(s, from).ok());
        auto expected = neighbourChoices(sorted.keys, s);
        CHECK(
            std::equal(expected.begin(), expected.end(), decoder.choices().begin(), decoder.choices().end()));
    }
}

TEST_CASE("the axis along which a slope is flat is raised, and no other") {
    std::mt19937 random(12);
    Points points(20000);
    for (auto& p : points) {
        p = {static_cast<std::uint32_t>(random() % (1u << 20)),
             static_cast<std::uint32_t>(random() % (1u << 20)), 0};
        p.z = 500000 + p.x / 50 + p.y / 90;
    }
    SortedPoints sorted = sortPoints(points);
    CHECK(sorted.layout.lift[2] > 0);
    Points turned = points; // z is where x was: the same slope, with another axis flat
    for (auto& p : turned)
        std::swap(p.x, p.z);
    SortedPoints sortedTurned = sortPoints(turned);
    CHECK(sortedTurned.layout.lift[0] > 0);
    CHECK(sortedTurned.layout.lift[2] == 0);
}

TEST_CASE("the order in which points come in leaves no trace") {
    std::mt19937 random(13);
    for (const Shape& shape : shapes()) {
        INFO(shape.name);
        Points shuffled = shape.points;
        std::shuffle(shuffled.begin(), shuffled.end(), random);
        CHECK(encode(sortPoints(shape.points), strataCount) == encode(sortPoints(shuffled), strataCount));
    }
}

TEST_CASE("damaged positions are errors or points inside the node") {
    for (const Shape& shape : shapes()) {
        INFO(shape.name);
        Points few(shape.points.begin(),
                   shape.points.begin() + std::min<std::ptrdiff_t>(200, std::ssize(shape.points)));
        auto count = static_cast<std::uint32_t>(few.size());
        std::uint64_t limit = std::uint64_t{1} << shape.nodeBits;
        forEachDamage(encode(sortPoints(few), strataCount), 1500, [&](const Bytes& damaged) {
            auto read = decode(damaged, count, shape.nodeBits, strataCount);
            if (read)
                for (const auto& p : *read)
                    if (p.x >= limit || p.y >= limit || p.z >= limit)
                        FAIL("a point outside the node");
        });
    }
}
