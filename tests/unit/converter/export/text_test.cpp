// Decimals, and filters as users write them.
#include "converter/export/filter_text.hpp"
#include "shared/select/minimum_distance.hpp"
#include "shared/select/value_ranges.hpp"
#include "shared/sinks/decimal.hpp"
#include "tests/support/counting_gate.hpp"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

using namespace stipple;

namespace {
std::string decimal(double scale, double offset, std::int64_t n) {
    std::string text;
    DecimalScale(scale, offset, std::min<std::int64_t>(n, 0), std::max<std::int64_t>(n, 0)).append(text, n);
    return text;
}
std::string boxError(const std::string& text) {
    auto box = boxFromText(text);
    REQUIRE_FALSE(box.ok());
    CHECK(box.error().code == ErrorCode::invalidArgument);
    return box.error().what;
}
} // namespace

TEST_CASE("scaled numbers are the decimals people mean") {
    CHECK(decimal(0.01, 0, 5) == "0.05");
    CHECK(decimal(0.01, 0, -5) == "-0.05");
    CHECK(decimal(0.01, 0, 0) == "0.00");
    CHECK(decimal(0.01, 500000, 1234567) == "512345.67");
    CHECK(decimal(0.001, 0.5, -500) == "0.000");
    CHECK(decimal(0.1, 0.2, 1) == "0.3"); // 0.30000000000000004 in double
    CHECK(decimal(1, 0, 17) == "17");
    CHECK(decimal(100, 3, 2) == "203");
    CHECK(decimal(1e-7, 180, -3600000001) == "-180.0000001");
    CHECK(decimal(0.25, 1e6, 3) == "1000000.75");
    CHECK(decimal(-0.5, 1, 1) == "0.5");
    CHECK(decimal(1e-5, -1e-9, 1) == "0.000009999");
}

TEST_CASE("the portable way to write numbers is the library's, but for neighbours of powers of two") {
    std::mt19937_64 random(5);
    int longer = 0;
    auto compare = [&](auto value) {
        std::string library, portably;
        appendShortest(library, value);
        portable::appendShortest(portably, value);
        if (library == portably)
            return;
        ++longer;
        INFO(library << " and " << portably);
        CHECK(portably.size() > library.size());
        decltype(value) back = sizeof value == 4
                                   ? static_cast<decltype(value)>(std::strtof(portably.c_str(), nullptr))
                                   : static_cast<decltype(value)>(std::strtod(portably.c_str(), nullptr));
        CHECK(back == value);
    };
    for (double value : {0.0, -0.0, 1.0, 0.1, 1e22, 1e-5, 123456.0, 1e5, 5e-324, 1.7976931348623157e308,
                         0x1p60, std::numeric_limits<double>::infinity(), std::nan("")})
        compare(value);
    for (int i = 0; i < 200'000; ++i) {
        compare(std::bit_cast<double>(random()));
        compare(std::bit_cast<float>(static_cast<std::uint32_t>(random())));
        compare(static_cast<double>(static_cast<std::int64_t>(random() >> (random() % 64))) / 1000);
    }
    for (int exponent = -1000; exponent < 1000; ++exponent) {
        compare(std::ldexp(1.0, exponent));
        CHECK(shortestScientific(std::ldexp(1.0, exponent)).find('e') != std::string::npos);
    }
    CHECK(longer < 100);
    CHECK(portable::shortestScientific(0.00125) == "1.25e-03");
}

TEST_CASE("decimals beyond 64 bits are exact, beyond 128 shortest doubles") {
    CHECK(decimal(1e-9, 4e12, 1) == "4000000000000.000000001");
    CHECK(decimal(1e-9, 0, std::numeric_limits<std::int64_t>::max()) == "9223372036.854775807");
    CHECK(decimal(1e-9, 0, std::numeric_limits<std::int64_t>::min()) == "-9223372036.854775808");
    CHECK(decimal(0.00030517578125, 0, 1) == "0.00030517578125");
    DecimalScale tiny(1e-40, 1, 0, 1);
    CHECK_FALSE(tiny.exact());
    CHECK(decimal(1e-40, 1, 0) == "1");
    CHECK(decimal(1e-40, 0, 2) == "2e-40");
    CHECK(decimal(std::nan(""), 0, 3) == "nan");
    // Outside what was announced it is slower, not wrong.
    std::string text;
    DecimalScale(0.01, 0, 0, 10).append(text, std::numeric_limits<std::int64_t>::max());
    CHECK(text == "92233720368547758.07");
}

TEST_CASE("decimals read back to the integers they were made of") {
    std::mt19937_64 random(1);
    for (double scale : {0.01, 0.001, 0.0001, 1e-7, 0.3048, 0.000125})
        for (double offset : {0.0, 637000.0, -0.05, 4567890.123}) {
            DecimalScale decimals(scale, offset, -2147483648, 2147483647);
            REQUIRE(decimals.exact());
            for (int i = 0; i < 200; ++i) {
                auto n = static_cast<std::int32_t>(random());
                std::string text;
                decimals.append(text, n);
                CHECK(std::llround((std::stold(text) - static_cast<long double>(offset)) /
                                   static_cast<long double>(scale)) == n);
            }
        }
}

TEST_CASE("floating point is the shortest text that reads back") {
    auto text = [](auto value) {
        std::string to;
        appendShortest(to, value);
        return to;
    };
    CHECK(text(0.1) == "0.1");
    CHECK(text(0.1f) == "0.1");
    CHECK(text(-0.0) == "-0");
    CHECK(text(std::nan("")) == "nan");
    CHECK(text(-std::numeric_limits<double>::infinity()) == "-inf");
    CHECK(text(402220818.3546734) == "402220818.3546734");
}

TEST_CASE("boxes are four or six numbers") {
    auto flat = boxFromText("1,2,3.5,-4e1");
    REQUIRE(flat.ok());
    CHECK(flat->min == Vec3d{1, 2, -std::numeric_limits<double>::infinity()});
    CHECK(flat->max == Vec3d{3.5, -40, std::numeric_limits<double>::infinity()});
    auto full = boxFromText(" 1, 2 ,3,+4,5,inf ");
    REQUIRE(full.ok());
    CHECK(full->max == Vec3d{4, 5, std::numeric_limits<double>::infinity()});
    CHECK(boxError("1,2,3") == "a box has four or six numbers, not 3");
    CHECK(boxError("1,2,3,x") == "\"x\" is no number of a box");
    CHECK(boxError("1,2,3,nan") == "\"nan\" is no number of a box");
    CHECK(boxError("1,2,,3") == "\"\" is no number of a box");
    CHECK(boxError("1 2 3 4").find("is no number") != std::string::npos);
}

TEST_CASE("classes are numbers and ranges") {
    auto ranges = rangesFromText("2, 6,40-45");
    REQUIRE(ranges.ok());
    CHECK(*ranges == std::vector<ValueRange>{{2, 2}, {6, 6}, {40, 45}});
    for (const char* wrong : {"", "x", "2,", "5-3", "-1", "1-", "1.5", "2;3", "99999999999"}) {
        auto refused = rangesFromText(wrong);
        INFO(wrong);
        REQUIRE_FALSE(refused.ok());
        CHECK(refused.error().what.find("is no class and no range of classes") != std::string::npos);
    }
}

TEST_CASE("ranges are closed, and open where nothing stands") {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    auto range = [](const char* text) {
        auto read = rangeFromText(text);
        return read ? *read : ValueRange{1, 0};
    };
    CHECK(range("1..2.5") == ValueRange{1, 2.5});
    CHECK(range("-5..-1") == ValueRange{-5, -1});
    CHECK(range("3..") == ValueRange{3, infinity});
    CHECK(range("..3") == ValueRange{-infinity, 3});
    CHECK(range("7") == ValueRange{7, 7});
    CHECK(range(" 1 .. 2 ") == ValueRange{1, 2});
    for (const char* wrong :
         {"", "..", "2..1", "x", "1..x", "nan", "1..inf", "-inf..1", "1..2..3", "1...", "1e999"}) {
        INFO(wrong);
        CHECK_FALSE(rangeFromText(wrong).ok());
    }
}

TEST_CASE("conditions are names and ranges") {
    auto shown = [](const char* text) {
        auto conditions = conditionsFromText(text);
        if (!conditions)
            return "refused: " + conditions.error().what;
        std::string all;
        for (const AttributeCondition& condition : *conditions) {
            CHECK(condition.ofMeaning);
            all += "[" + condition.attribute;
            for (const ValueRange& range : condition.ranges)
                all += " " + std::to_string(static_cast<int>(range.min)) + "-" +
                       std::to_string(static_cast<int>(range.max));
            all += "]";
        }
        return all;
    };
    CHECK(shown("Intensity:100..200") == "[Intensity 100-200]");
    CHECK(shown("Intensity:1..2,5;Return Number : 1") == "[Intensity 1-2 5-5][Return Number 1-1]");
    CHECK(shown("a:b:1;c;d:2") == "[a:b 1-1][c;d 2-2]"); // names of any kind
    CHECK(shown("a:1;") == "refused: it names no attribute");
    CHECK(shown("") == "refused: it names no attribute");
    CHECK(shown(":1") == "refused: it names no attribute");
    CHECK(shown("Intensity") == "refused: it names no attribute");
    CHECK(shown("Intensity:") == "refused: a range has a limit");
    CHECK(shown("Intensity:5..4") == "refused: the range is empty");
    CHECK(shown("a:x;b:1") == "[a:x;b 1-1]");
}

TEST_CASE("lines are points") {
    auto line = lineFromText("1,2;3.5,-4;5e1,6");
    REQUIRE(line.ok());
    CHECK(*line == std::vector<Point2d>{{1, 2}, {3.5, -4}, {50, 6}});
    for (const char* wrong : {"", "1,2", "1,2;3", "1,2;3,4,5", "1,2;3,x", "1,2;", "1,2;3,inf", "1 2;3 4"}) {
        INFO(wrong);
        CHECK_FALSE(lineFromText(wrong).ok());
    }
}

TEST_CASE("rotated boxes are a centre, sizes and a rotation") {
    auto holds = [](const char* text, Vec3d p) {
        auto box = rotatedBoxFromText(text);
        REQUIRE(box.ok());
        return (*box)->contains(p);
    };
    CHECK(holds("10,20,5;8,2,4;90", {10, 24, 7}));
    CHECK_FALSE(holds("10,20,5;8,2,4;90", {14, 20, 5}));
    CHECK(holds("10,20;8,2", {14, 21, 1e6}));
    CHECK(holds("10,20,5;8,2,4;0,0,1,1", {10, 23.9, 5}));
    for (const char* wrong : {"", "1,2", "1,2;3,4;5;6", "1,2;3,x", "1,2;3,4;0,0,0,1", "1,2,3;4,5"}) {
        INFO(wrong);
        CHECK_FALSE(rotatedBoxFromText(wrong).ok());
    }
}

TEST_CASE("ranges of meanings become ranges of stored values") {
    Attribute attribute{"a", AttributeType::i32};
    CHECK(storedRanges(attribute, {{1.5, 2.5}}) == std::vector<ValueRange>{{1.5, 2.5}});
    attribute.scale = 0.01;
    attribute.offset = 100;
    CHECK(storedRanges(attribute, {{100.07, 100.29}}) == std::vector<ValueRange>{{7, 29}});
    CHECK(storedRanges(attribute, {{100.071, 100.289}}) == std::vector<ValueRange>{{8, 28}});
    attribute.scale = -0.5;
    CHECK(storedRanges(attribute, {{99, 100.2}}) == std::vector<ValueRange>{{0, 2}});
    constexpr double infinity = std::numeric_limits<double>::infinity();
    CHECK(storedRanges(attribute, {{99, infinity}}) == std::vector<ValueRange>{{-infinity, 2}});
    attribute.noData = 1;
    CHECK(storedRanges(attribute, {{99, 100.2}}) == std::vector<ValueRange>{{0, 0}, {2, 2}});
    CHECK(storedRanges(attribute, {{99.5, 99.5}}).empty());
    Attribute real{"r", AttributeType::f64};
    real.noData = -9999;
    CHECK(storedRanges(real, {{-9999, -9999}}).empty());
    CHECK(storedRanges(real, {{0, 1}}) == std::vector<ValueRange>{{0, 1}});
    auto open = storedRanges(real, {{-infinity, 0}});
    REQUIRE(open.size() == 2);
    CHECK(open[0].max < -9999);
    CHECK(open[1].min > -9999);
}

TEST_CASE("attributes are found by name, in any case, commas included") {
    Schema schema;
    for (const char* name : {"Intensity", "height, above ground", "red", "Red"})
        schema.attributes.push_back({.name = name});
    auto found = [&](const std::vector<std::string>& texts) {
        auto attributes = attributesFromTexts(schema, texts);
        return attributes ? *attributes : std::vector<int>{-1};
    };
    CHECK(found({"intensity, red,intensity"}) == std::vector<int>{0, 2});
    CHECK(found({"Red", "height, above ground"}) == std::vector<int>{3, 1});
    CHECK(found({""}).empty());
    auto unknown = attributesFromTexts(schema, {"Intensity,RED"});
    REQUIRE_FALSE(unknown.ok());
    CHECK(unknown.error().sentence() ==
          "the cloud has no attribute \"RED\" (it has Intensity, height, above ground, red, Red)");
}

TEST_CASE("thinned points keep their distance, and each point left out is near to one kept") {
    std::mt19937_64 random(4);
    for (double distance : {1e-100, 0.1, 0.5, 3.0, 40.0, 1e9}) {
        std::vector<Vec3i> points;
        for (int i = 0; i < 1500; ++i)
            points.push_back({static_cast<std::int64_t>(random() % 200) - 50,
                              static_cast<std::int64_t>(random() % 200),
                              static_cast<std::int64_t>(random() % 10)});
        Vec3d scale{0.5, 0.25, 1};
        auto squared = [&](std::size_t a, std::size_t b) {
            Vec3i d = points[a] - points[b];
            double x = double(d.x) * scale.x, y = double(d.y) * scale.y, z = double(d.z) * scale.z;
            return x * x + y * y + z * z;
        };
        std::vector<std::uint32_t> expected; // greedy, by looking at all
        for (std::uint32_t i = 0; i < points.size(); ++i)
            if (std::none_of(expected.begin(), expected.end(),
                             [&](std::uint32_t kept) { return squared(kept, i) < distance * distance; }))
                expected.push_back(i);
        auto kept = thinned(points, {-50, 0, 0}, scale, distance);
        REQUIRE(kept.ok());
        CHECK(*kept == expected);
    }
}

TEST_CASE("thinning to less than a grid step takes no longer than to one") {
    std::mt19937_64 random(5);
    std::vector<Vec3i> points;
    for (int i = 0; i < 30000; ++i)
        points.push_back(
            {static_cast<std::int64_t>(random() % 100000), static_cast<std::int64_t>(random() % 100000), 7});
    auto secondsTo = [&](double distance) {
        double before = test::CountingGate::cpuSeconds();
        auto kept = thinned(points, {0, 0, 0}, {0.01, 0.01, 0}, distance);
        REQUIRE(kept.ok());
        CHECK(kept->size() > 29900);
        return test::CountingGate::cpuSeconds() - before;
    };
    double usual = secondsTo(0.01);
    CHECK(secondsTo(1e-100) < 10 * usual); // a hundred times, when all of them shared a cell
    CHECK(secondsTo(1e-9) < 10 * usual);
}
