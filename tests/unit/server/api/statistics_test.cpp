// Statistics by address, against every point.
#include "converter/build/convert.hpp"
#include "server/api/point_statistics.hpp"
#include "shared/base/text.hpp"
#include "shared/io/file_source.hpp"
#include "shared/las/las_writer.hpp"
#include "tests/support/data.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/server/api/points_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <map>

using namespace stipple;
using namespace stipple::server;
using namespace stipple::test;
using nlohmann::json;

namespace {

// The values of one column, as they are meant.
using Column = std::vector<double>;

std::map<double, std::uint64_t> countsOf(const Column& values) {
    std::map<double, std::uint64_t> counts;
    for (double value : values)
        ++counts[value];
    return counts;
}

void checkColumn(const json& found, const Column& values) {
    INFO(found.dump().substr(0, 500));
    REQUIRE(found["count"] == values.size());
    if (values.empty()) {
        CHECK_FALSE(found.contains("min"));
        return;
    }
    CHECK(found["min"] == *std::min_element(values.begin(), values.end()));
    CHECK(found["max"] == *std::max_element(values.begin(), values.end()));
    long double sum = 0, squares = 0;
    for (double value : values)
        sum += value;
    auto mean = sum / static_cast<long double>(values.size());
    for (double value : values)
        squares += (value - mean) * (value - mean);
    auto deviation = static_cast<double>(std::sqrt(squares / static_cast<long double>(values.size())));
    if (found.contains("mean")) {
        CHECK(found["mean"].get<double>() == Approx(static_cast<double>(mean)).epsilon(1e-11).margin(1e-12));
        CHECK(found["deviation"].get<double>() == Approx(deviation).epsilon(1e-9).margin(1e-9));
    }
    if (found.contains("values")) {
        std::map<double, std::uint64_t> counts;
        for (const json& one : found["values"])
            counts[one["value"]] = one["points"];
        CHECK((counts == countsOf(values)));
    }
    if (!found.contains("histogram"))
        return;
    const std::vector<double> edges = found["histogram"]["edges"];
    std::vector<std::uint64_t> counts(edges.size() - 1);
    bool isInside = true;
    for (double value : values) {
        std::size_t i = 0; // looked for one by one
        while (i + 2 < edges.size() && value >= edges[i + 1])
            ++i;
        isInside = isInside && value >= edges[i] && value <= edges[i + 1];
        ++counts[i];
    }
    CHECK(isInside);
    CHECK((found["histogram"]["counts"] == counts));
}

const json& named(const json& list, const std::string& name) {
    for (const json& one : list)
        if (one["name"] == name)
            return one;
    FAIL("no " << name);
    return list;
}

// A scan with classes, returns, and a scaled attribute some of whose values mean "no value".
struct Scan {
    TemporaryFolder folder;
    las::WriterOptions options;
    PointBatch points;
    std::size_t count = 6000;

    Scan() {
        options.grid = {{0.01, 0.01, 0.01}, {500000, 4000000, 0}};
        options.schema = las::schemaOf(6);
        options.pointFormat = 6;
        Attribute height{"Height", AttributeType::i16};
        height.scale = 0.1;
        height.offset = 5;
        height.noData = -9999;
        options.schema.attributes.push_back(height);
        points.resize(options.schema, count);
        auto set = [&](std::string_view name, auto value) {
            int a = options.schema.find(name);
            REQUIRE(a >= 0);
            for (std::size_t i = 0; i < count; ++i)
                points.setValue(a, i, value(i));
        };
        for (std::size_t i = 0; i < count; ++i)
            points.positions[i] = {static_cast<std::int64_t>(i * 7919 % 60000),
                                   static_cast<std::int64_t>(i * 104729 % 40000),
                                   static_cast<std::int64_t>(i % 500)};
        set("Classification", [](std::size_t i) { return static_cast<std::uint8_t>(i % 7); });
        set("Return Number", [](std::size_t i) { return static_cast<std::uint8_t>(1 + i % 3); });
        set("Number of Returns", [](std::size_t) { return std::uint8_t{3}; });
        set("Intensity", [](std::size_t i) { return static_cast<std::uint16_t>(i * 31 % 60000); });
        set("Height", [](std::size_t i) {
            return static_cast<std::int16_t>(i % 5 == 0 ? -9999 : static_cast<int>(i * 13 % 2000) - 1000);
        });
        auto writer = las::Writer::create(folder.file("in.las"), options);
        REQUIRE(writer.ok());
        REQUIRE((*writer)->write(points).ok());
        REQUIRE((*writer)->finish().ok());
        REQUIRE(convertFiles({folder.file("in.las")}, folder.file("c.stipple"), {}, [](auto&&...) {}).ok());
    }
    template <class T>
    Column values(const char* name, const std::function<bool(std::size_t)>& wanted) const {
        int a = options.schema.find(name);
        const Attribute& attribute = options.schema.attributes[static_cast<std::size_t>(a)];
        Column column;
        for (std::size_t i = 0; i < count; ++i) {
            auto stored = static_cast<double>(points.value<T>(a, i));
            if (wanted(i) && !(attribute.noData && stored == *attribute.noData))
                column.push_back(attribute.offset + attribute.scale * stored);
        }
        return column;
    }
    Column axis(int axis, const std::function<bool(std::size_t)>& wanted) const {
        Column column;
        for (std::size_t i = 0; i < count; ++i)
            if (wanted(i))
                column.push_back(options.grid.toWorld(points.positions[i])[axis]);
        return column;
    }
};

void checkAll(const Scan& scan, const json& found, const std::function<bool(std::size_t)>& wanted) {
    const json& attributes = found["attributes"];
    checkColumn(named(attributes, "Intensity"), scan.values<std::uint16_t>("Intensity", wanted));
    checkColumn(named(attributes, "Classification"), scan.values<std::uint8_t>("Classification", wanted));
    checkColumn(named(attributes, "Height"), scan.values<std::int16_t>("Height", wanted));
    for (int axis = 0; axis < 3; ++axis)
        checkColumn(found["coordinates"][static_cast<std::size_t>(axis)], scan.axis(axis, wanted));
    std::uint64_t points = 0;
    for (const json& level : found["levels"])
        points += level["points"].get<std::uint64_t>();
    CHECK(found["pointCount"] == points);
}

} // namespace

TEST_CASE("a value lies in the interval whose edges hold it") {
    std::vector<double> edges{0, 0.1, 0.2, 0.30000000000000004, 0.4};
    CHECK(intervalOf(edges, 0) == 0);
    CHECK(intervalOf(edges, 0.1) == 1);
    CHECK(intervalOf(edges, std::nextafter(0.1, 0)) == 0);
    CHECK(intervalOf(edges, 0.3) == 2);
    CHECK(intervalOf(edges, 0.30000000000000004) == 3);
    CHECK(intervalOf(edges, 0.4) == 3);
    for (double outside : {-0.1, 0.5, std::nan("")})
        CHECK_FALSE(intervalOf(edges, outside));
    CHECK(intervalOf({7, 7}, 7) == 0);
    CHECK_FALSE(intervalOf({}, 7));
}

TEST_CASE("statistics of a cloud and of its parts are those of their points") {
    Scan scan;
    ApiFixture api(scan.folder.file("c.stipple"));
    auto ask = [&](const std::string& query) {
        ApiAnswer answer = api.ask(cat("/api/v1/clouds/c/statistics", query));
        INFO(answer.body.substr(0, 300));
        REQUIRE(answer.status == 200);
        return answer.json;
    };
    auto all = [](std::size_t) { return true; };
    auto world = [&](std::size_t i) { return scan.options.grid.toWorld(scan.points.positions[i]); };

    SECTION("told by the file where that is enough") {
        json found = ask("?attributes=Intensity,Classification,Return%20Number,Number%20of%20Returns");
        CHECK(found["isComputed"] == false);
        CHECK(found["pointCount"] == scan.count);
        checkColumn(named(found["attributes"], "Intensity"), scan.values<std::uint16_t>("Intensity", all));
        checkColumn(named(found["attributes"], "Classification"),
                    scan.values<std::uint8_t>("Classification", all));
        CHECK_FALSE(found["coordinates"][0].contains("mean"));
        checkColumn(found["coordinates"][2], scan.axis(2, all));
        REQUIRE(found["classes"].size() == 7);
        CHECK(found["classes"][2] == json{{"class", 2}, {"name", "Ground"}, {"points", 857}});
        CHECK(found["returns"]["numbers"][0] == json{{"return", 1}, {"points", 2000}});
        CHECK(found["returns"]["pulses"] == json::array({{{"returns", 3}, {"points", 6000}}}));
        double area = (599.99 - 0) * (399.99 - 0); // nearly: every integer of an axis is taken
        CHECK(found["density"]["area"].get<double>() == Approx(area).epsilon(1e-3));
        CHECK(found["density"]["pointsPerArea"].get<double>() ==
              Approx(6000 / found["density"]["area"].get<double>()));
    }
    SECTION("computed where an attribute has values that mean none") {
        json found = ask("");
        CHECK(found["isComputed"] == true);
        checkAll(scan, found, all);
        CHECK(named(found["attributes"], "Height")["count"] == 4800);
    }
    SECTION("in intervals") {
        json found = ask("?bins=17");
        checkAll(scan, found, all);
        CHECK(named(found["attributes"], "Intensity")["histogram"]["counts"].size() == 17);
        CHECK(named(found["attributes"], "Number of Returns")["histogram"]["counts"] ==
              json::array({6000})); // one value
    }
    SECTION("in a box") {
        json found = ask("?box=500100,4000050.5,500300,4000250&bins=9");
        checkAll(scan, found, [&](std::size_t i) {
            Vec3d p = world(i);
            return p.x >= 500100 && p.x <= 500300 && p.y >= 4000050.5 && p.y <= 4000250;
        });
        CHECK(found["pointCount"] > 500);
        CHECK(found["bounds"]["min"][0] == found["coordinates"][0]["min"]);
    }
    SECTION("of classes and values") {
        json found = ask("?class=2,5&where=Height:-20..50");
        checkAll(scan, found, [&](std::size_t i) {
            int stored = static_cast<int>(i * 13 % 2000) - 1000;
            return (i % 7 == 2 || i % 7 == 5) && i % 5 != 0 && stored >= -250 && stored <= 450;
        });
        CHECK(found["pointCount"] > 300);
        CHECK(found["classes"].size() == 2);
    }
    SECTION("of no points") {
        json found = ask("?box=0,0,1,1&bins=3");
        CHECK(found["pointCount"] == 0);
        CHECK(found["bounds"].is_null());
        CHECK(found["density"].is_null());
        CHECK(found["levels"].empty());
        checkColumn(named(found["attributes"], "Intensity"), {});
    }
    SECTION("of a level of detail") {
        ApiAnswer points = api.ask("/api/v1/clouds/c/points?spacing=20&format=las");
        json found = ask("?spacing=20");
        CHECK(found["pointCount"] == lasOf(points.body).points.size());
        CHECK(found["pointCount"] < scan.count);
    }
    SECTION("of attributes that are asked for") {
        json found = ask("?attributes=none&bins=2");
        CHECK(found["attributes"].empty());
        CHECK_FALSE(found.contains("classes"));
        CHECK(found["coordinates"][1]["histogram"]["counts"].size() == 2);
    }
}

TEST_CASE("statistics do not depend on threads, and are bounded") {
    Scan scan;
    ApiLimits limits;
    limits.points.threads = 3;
    ApiFixture one(scan.folder.file("c.stipple")), three(scan.folder.file("c.stipple"), limits);
    const std::string target = "/api/v1/clouds/c/statistics?bins=50&box=500000,4000000,500500,4000300";
    CHECK(one.ask(target).body == three.ask(target).body);

    limits.points.maxPoints = 5999;
    ApiFixture bounded(scan.folder.file("c.stipple"), limits);
    ApiAnswer refused = bounded.ask("/api/v1/clouds/c/statistics?bins=1");
    CHECK(refused.status == 400);
    CHECK(refused.json["type"] == "/api/v1/problems/work-too-large");
    CHECK(bounded.ask("/api/v1/clouds/c/statistics?attributes=Intensity").status == 200); // reads none
}

TEST_CASE("statistics are computed once for each query and version, and kept within a bound") {
    Scan scan;
    ApiFixture api(scan.folder.file("c.stipple"));
    const std::string target = "/api/v1/clouds/c/statistics?bins=50&box=500000,4000000,500500,4000300";
    auto counts = [&] { return api.resources().statistics.counts(); };
    ApiAnswer first = api.ask(target), second = api.ask(target);
    CHECK(first.body == second.body);
    CHECK(first.field("ETag") == second.field("ETag"));
    CHECK(counts().misses == 1);
    CHECK(counts().hits == 1);
    // In another order and with what is usual: the same answer.
    CHECK(api.ask("/api/v1/clouds/c/statistics?box=500000,4000000,500500,4000300&bins=50").body ==
          first.body);
    CHECK(counts().misses == 1);
    CHECK(api.ask("/api/v1/clouds/c/statistics?bins=51&box=500000,4000000,500500,4000300").body !=
          first.body);
    CHECK(counts().misses == 2);

    ApiLimits limits;
    limits.statisticsBytes = 2 * first.body.size();
    ApiFixture small(scan.folder.file("c.stipple"), limits);
    for (int bins = 20; bins < 60; ++bins) {
        CHECK(small.ask("/api/v1/clouds/c/statistics?bins=" + std::to_string(bins)).status == 200);
        CHECK(small.resources().statistics.counts().bytes <= limits.statisticsBytes);
    }
    CHECK(small.resources().statistics.counts().evicted > 30);
}

TEST_CASE("statistics of regions of autzen are those of the scan", "[slow]") {
    STIPPLE_NEEDS_DATA();
    const std::string scan = dataPath("clouds/autzen.laz");
    TemporaryFolder folder;
    REQUIRE(convertFiles({scan}, folder.file("autzen.stipple"), {}, [](auto&&...) {}).ok());
    auto source = openFileSource(scan);
    REQUIRE(source.ok());
    auto reader = las::Reader::open(**source);
    REQUIRE(reader.ok());
    const Schema& schema = (*reader)->schema();
    const int intensity = schema.find("Intensity"), red = schema.find("Red");
    struct Region {
        std::string query;
        std::function<bool(Vec3d)> holds;
        Column intensity, red, z;
    };
    std::vector<Region> regions{
        {"bins=100", [](Vec3d) { return true; }, {}, {}, {}},
        {"box=636500,850000,638000.5,851200&bins=64",
         [](Vec3d p) { return p.x >= 636500 && p.x <= 638000.5 && p.y >= 850000 && p.y <= 851200; },
         {},
         {},
         {}},
        {"polygon=636000,849000;638000,849000;636000,852000&minz=420&maxz=500",
         [](Vec3d p) {
             return p.x >= 636000 && p.y >= 849000 && 3 * (p.x - 636000) + 2 * (p.y - 849000) <= 6000 &&
                    p.z >= 420 && p.z <= 500;
         },
         {},
         {},
         {}}};
    PointBatch batch;
    for (std::uint64_t first = 0; first < (*reader)->pointCount(); first += 500'000) {
        REQUIRE((*reader)->read(first, 500'000, batch).ok());
        for (std::size_t i = 0; i < batch.size(); ++i) {
            Vec3d place = (*reader)->header().grid.toWorld(batch.positions[i]);
            for (Region& region : regions) {
                if (!region.holds(place))
                    continue;
                region.intensity.push_back(batch.value<std::uint16_t>(intensity, i));
                region.red.push_back(batch.value<std::uint16_t>(red, i));
                region.z.push_back(place.z);
            }
        }
    }
    ApiFixture api(folder.file("autzen.stipple"));
    for (const Region& region : regions) {
        INFO(region.query);
        ApiAnswer answer = api.ask(cat("/api/v1/clouds/autzen/statistics?", region.query));
        REQUIRE(answer.status == 200);
        CHECK(region.z.size() > 100'000);
        CHECK(answer.json["pointCount"] == region.z.size());
        checkColumn(named(answer.json["attributes"], "Intensity"), region.intensity);
        checkColumn(named(answer.json["attributes"], "Red"), region.red);
        checkColumn(answer.json["coordinates"][2], region.z);
    }
}
