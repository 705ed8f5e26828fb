#include "converter/build/compare.hpp"

#include "converter/build/morton.hpp"

#include <catch2/catch.hpp>

#include <map>
#include <numeric>
#include <random>

using namespace stipple;

namespace {
const Schema schema{{{"a", AttributeType::u8}, {"b", AttributeType::u16}}};
const Grid grid{{1, 1, 1}, {0, 0, 0}};

struct Point {
    std::int64_t x = 0;
    int a = 0, b = 0;
    friend auto operator<=>(const Point&, const Point&) = default;
};

Bytes rowsOf(const std::vector<Point>& points) {
    PointBatch batch;
    batch.resize(schema, points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        batch.positions[i] = {points[i].x, points[i].x / 3, 5};
        batch.setValue<std::uint8_t>(0, i, static_cast<std::uint8_t>(points[i].a));
        batch.setValue<std::uint16_t>(1, i, static_cast<std::uint16_t>(points[i].b));
    }
    RowLayout layout(schema, {{-1000, -1000, 0}, {100000, 100000, 10}});
    Bytes rows(points.size() * layout.rowBytes());
    std::vector<std::uint32_t> all(points.size());
    std::iota(all.begin(), all.end(), 0u);
    layout.pack(batch, all, rows.data());
    return rows;
}

Comparison compare(const std::vector<Point>& file, const std::vector<Point>& inputs) {
    RowLayout layout(schema, {{-1000, -1000, 0}, {100000, 100000, 10}});
    PointComparer comparer(layout, grid);
    comparer.begin(file.size() / 3); // less than there are: it grows
    Bytes fileRows = rowsOf(file), inputRows = rowsOf(inputs);
    comparer.addFile(fileRows.data(), file.size());
    comparer.addInput(inputRows.data(), inputs.size());
    return comparer.finish();
}

// By sorting, position by position.
Comparison compareSlowly(std::vector<Point> file, std::vector<Point> inputs) {
    Comparison result;
    std::map<std::int64_t, std::pair<std::vector<Point>, std::vector<Point>>> places;
    std::sort(file.begin(), file.end());
    std::sort(inputs.begin(), inputs.end());
    for (const Point& p : file)
        places[p.x].first.push_back(p);
    for (const Point& p : inputs)
        places[p.x].second.push_back(p);
    for (auto& [x, sides] : places) {
        std::vector<Point> left, right;
        std::set_difference(sides.first.begin(), sides.first.end(), sides.second.begin(), sides.second.end(),
                            std::back_inserter(left));
        std::set_difference(sides.second.begin(), sides.second.end(), sides.first.begin(), sides.first.end(),
                            std::back_inserter(right));
        std::size_t pairs = std::min(left.size(), right.size());
        result.equalPoints += sides.first.size() - left.size();
        result.changed += pairs;
        result.surplus += left.size() - pairs;
        result.missing += right.size() - pairs;
    }
    return result;
}
} // namespace

TEST_CASE("sets of points are compared as multisets, like by sorting them", "[compare]") {
    std::mt19937_64 random(1);
    for (int round = 0; round < 60; ++round) {
        auto some = [&](std::size_t most) {
            std::vector<Point> points(random() % most);
            for (Point& p : points)
                p = {static_cast<std::int64_t>(random() % (1 + round * 7)) - 20,
                     static_cast<int>(random() % 3), static_cast<int>(random() % 2) * 300};
            return points;
        };
        std::vector<Point> file = some(3000), inputs = file;
        std::shuffle(inputs.begin(), inputs.end(), random);
        for (const Point& p : some(round % 2 == 0 ? 20 : 3000))
            inputs.push_back(p);
        inputs.resize(inputs.size() - std::min<std::size_t>(inputs.size(), random() % 50));
        Comparison fast = compare(file, inputs), slow = compareSlowly(file, inputs);
        CHECK(fast.filePoints == file.size());
        CHECK(fast.inputPoints == inputs.size());
        CHECK(fast.equalPoints == slow.equalPoints);
        CHECK(fast.changed == slow.changed);
        CHECK(fast.missing == slow.missing);
        CHECK(fast.surplus == slow.surplus);
        CHECK(compare(file, file).same());
    }
}

TEST_CASE("differences name the place, the attributes and how many there are", "[compare]") {
    std::vector<Point> file{{1, 2, 3}, {1, 2, 3}, {7, 1, 1}, {9, 0, 0}},
        inputs{{1, 2, 300}, {1, 2, 300}, {7, 1, 1}, {8, 0, 0}};
    Comparison result = compare(file, inputs);
    CHECK(result.equalPoints == 1);
    CHECK(result.changed == 2);
    CHECK(result.changedPerAttribute == std::vector<std::uint64_t>{0, 2});
    CHECK(result.missing == 1);
    CHECK(result.surplus == 1);
    REQUIRE(result.first.size() == 3);
    CHECK(result.first[0].text == "at (1, 0, 5): b is 3, not 300 (2 times)");
    CHECK(result.first[1].text == "at (8, 2, 5): a point of the inputs is not in the file");
    CHECK(result.first[2].text == "at (9, 3, 5): the file has a point that is not in the inputs");
}

TEST_CASE("the first differences are the first in Morton order, however they were found", "[compare]") {
    std::vector<Point> inputs;
    for (int x = 0; x < 200; ++x)
        inputs.push_back({x * 37 % 200, 0, 0});
    Comparison whole = compare({}, inputs), pieces;
    for (std::size_t first = 0; first < inputs.size(); first += 20) {
        std::vector<Point> part(inputs.begin() + static_cast<std::ptrdiff_t>(first),
                                inputs.begin() + static_cast<std::ptrdiff_t>(first) + 20);
        pieces.add(compare({}, part));
    }
    Comparison single;
    for (const Point& p : inputs)
        single.addMissing(grid, {p.x, p.x / 3, 5});
    single.add({});
    for (const Comparison* other : {&pieces, &single}) {
        CHECK(other->missing == 200);
        REQUIRE(other->first.size() == Comparison::mostDifferences);
        for (std::size_t i = 0; i < other->first.size(); ++i)
            CHECK(other->first[i].text == whole.first[i].text);
    }
    for (std::size_t i = 1; i < whole.first.size(); ++i)
        CHECK(compareMorton(whole.first[i - 1].position, whole.first[i].position) < 0);
}

TEST_CASE("any number of equal points takes the room of one", "[compare]") {
    CountedRows rows(4);
    const std::uint8_t row[4] = {1, 2, 3, 4}, other[4] = {1, 2, 3, 5};
    const std::uint32_t hash = CountedRows::hashOf(row, 4);
    for (int i = 0; i < 1000000; ++i)
        rows.add(row, hash);
    CHECK_FALSE(rows.take(other, hash)); // a hash is not a row
    std::uint64_t distinct = 0, count = 0;
    rows.forEach([&](const std::uint8_t*, std::uint64_t times) {
        ++distinct;
        count += times;
    });
    CHECK(distinct == 1);
    CHECK(count == 1000000);
    for (int i = 0; i < 1000000; ++i)
        REQUIRE(rows.take(row, hash));
    CHECK_FALSE(rows.take(row, hash));
}
