#include "converter/build/statistics.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace stipple;

namespace {
template <class T>
AttributeStatistics statisticsOfValues(AttributeType type, const std::vector<T>& first,
                                       const std::vector<T>& second) {
    Schema schema{{{"value", type}}};
    BatchStatistics all = emptyStatistics(schema);
    for (const std::vector<T>* part : {&first, &second}) {
        PointBatch batch;
        batch.resize(schema, part->size());
        for (std::size_t i = 0; i < part->size(); ++i)
            batch.setValue<T>(0, i, (*part)[i]);
        merge(all, statisticsOf(schema, batch));
    }
    return all[0].finish();
}
} // namespace

TEST_CASE("statistics of two nodes are those of all their points", "[statistics]") {
    AttributeStatistics s =
        statisticsOfValues<std::uint16_t>(AttributeType::u16, {1, 2, 3, 4}, {10, 10, 10, 40});
    CHECK(s.min == 1);
    CHECK(s.max == 40);
    CHECK(s.mean == Approx(10));
    CHECK(s.deviation == Approx(std::sqrt((81 + 64 + 49 + 36 + 900) / 8.0)));
    REQUIRE(s.histogram.size() == 6);
    CHECK(s.histogram[4] == std::pair<std::int64_t, std::uint64_t>{10, 3});
}

TEST_CASE("signed values count as what they are", "[statistics]") {
    AttributeStatistics s = statisticsOfValues<std::int8_t>(AttributeType::i8, {-3, -3, 5}, {-128});
    CHECK(s.min == -128);
    CHECK(s.histogram.front() == std::pair<std::int64_t, std::uint64_t>{-128, 1});
    CHECK(s.mean == Approx(-129 / 4.0));
}

TEST_CASE("values far apart are counted too", "[statistics]") {
    AttributeStatistics s =
        statisticsOfValues<std::int32_t>(AttributeType::i32, {-2000000000, 2000000000}, {2000000000});
    REQUIRE(s.histogram.size() == 2);
    CHECK(s.histogram[1].second == 2);
}

TEST_CASE("a constant attribute has no deviation", "[statistics]") {
    AttributeStatistics s = statisticsOfValues<double>(AttributeType::f64, {0.1, 0.1, 0.1}, {0.1});
    CHECK(s.mean == 0.1);
    CHECK(s.deviation == 0);
    CHECK(s.histogram.empty());
}

TEST_CASE("values that are no number are left out", "[statistics]") {
    double nan = std::numeric_limits<double>::quiet_NaN();
    AttributeStatistics s = statisticsOfValues<double>(AttributeType::f64, {nan, 1, 3}, {nan, nan});
    CHECK(s.min == 1);
    CHECK(s.max == 3);
    CHECK(s.mean == 2);
    CHECK(s.deviation == 1);
}

TEST_CASE("more than 256 values give no histogram, in one node or in two", "[statistics]") {
    std::vector<std::uint16_t> low, high;
    for (std::uint16_t i = 0; i < 200; ++i) {
        low.push_back(i);
        high.push_back(static_cast<std::uint16_t>(i + 150));
    }
    CHECK(statisticsOfValues<std::uint16_t>(AttributeType::u16, low, low).histogram.size() == 200);
    CHECK(statisticsOfValues<std::uint16_t>(AttributeType::u16, low, high).histogram.empty());
}
