// Regions of a real scan by address, against every point of the scan itself.
#include "converter/build/convert.hpp"
#include "shared/base/text.hpp"
#include "shared/io/file_source.hpp"
#include "shared/io/memory_source.hpp"
#include "shared/las/las_writer.hpp"
#include "tests/support/data.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/server/api/points_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

using namespace stipple;
using namespace stipple::test;

namespace {

// Points as bytes that can be sorted: integers and every attribute, in the order of a schema.
using Records = std::vector<std::string>;

void addRecord(Records& to, const Schema& schema, const PointBatch& points, std::size_t i) {
    std::string record(reinterpret_cast<const char*>(&points.positions[i]), sizeof(Vec3i));
    for (std::size_t a = 0; a < schema.attributes.size(); ++a) {
        std::size_t size = schema.attributes[a].size();
        record.append(reinterpret_cast<const char*>(points.columns[a].data() + i * size), size);
    }
    to.push_back(std::move(record));
}

struct Region {
    const char* name;
    std::string query; // of /points or /profile
    bool isProfile;
    // x, y, z, and the values of Intensity and Classification.
    std::function<bool(Vec3d, unsigned, unsigned)> holds;
};

std::vector<Region> regions() {
    const Vec3d c{637291.3, 851210.7, 460.05};
    const double degrees = std::atan2(3.0, 4.0) * 180 / 3.14159265358979323846;
    char turn[40];
    std::snprintf(turn, sizeof turn, "%.17g", degrees);
    auto along = [=](Vec3d p) { return (4 * (p.x - c.x) + 3 * (p.y - c.y)) / 5; };
    auto across = [=](Vec3d p) { return (4 * (p.y - c.y) - 3 * (p.x - c.x)) / 5; };
    return {
        {"box", "box=636500,850000,410,638000.5,851200,470.25", false,
         [](Vec3d p, unsigned, unsigned) {
             return p.x >= 636500 && p.x <= 638000.5 && p.y >= 850000 && p.y <= 851200 && p.z >= 410 &&
                    p.z <= 470.25;
         }},
        {"rotated box", cat("center=637291.3,851210.7,460.05&size=2000.02,900.02,60&rotation=", turn), false,
         [=](Vec3d p, unsigned, unsigned) {
             return std::abs(along(p)) <= 1000.01 && std::abs(across(p)) <= 450.01 &&
                    std::abs(p.z - c.z) <= 30;
         }},
        {"polygon and heights", "polygon=636000,849000;638000,849000;636000,852000&minz=420&maxz=500", false,
         [](Vec3d p, unsigned, unsigned) {
             return p.x >= 636000 && p.y >= 849000 && 3 * (p.x - 636000) + 2 * (p.y - 849000) <= 6000 &&
                    p.z >= 420 && p.z <= 500;
         }},
        {"class and values", "box=636500,850000,637500,851000&class=0-1&where=Intensity:50..90,200..", false,
         [](Vec3d p, unsigned intensity, unsigned classification) {
             return p.x >= 636500 && p.x <= 637500 && p.y >= 850000 && p.y <= 851000 && classification <= 1 &&
                    ((intensity >= 50 && intensity <= 90) || intensity >= 200);
         }},
        {"profile", cat("line=", c.x - 800, ",", c.y - 600, ";", c.x + 800, ",", c.y + 600, "&width=200.02"),
         true, [=](Vec3d p, unsigned, unsigned) {
             return std::abs(along(p)) <= 1000 && std::abs(across(p)) <= 100.01;
         }}};
}

} // namespace

TEST_CASE("points are chosen by classes") {
    TemporaryFolder folder;
    las::WriterOptions options;
    options.grid = {{0.01, 0.01, 0.01}, {500000, 4000000, 0}};
    options.schema = las::schemaOf(6);
    options.pointFormat = 6;
    PointBatch points;
    points.resize(options.schema, 4000);
    int classification = options.schema.find("Classification");
    for (std::size_t i = 0; i < points.size(); ++i) {
        points.positions[i] = {static_cast<std::int64_t>(i * 7919 % 60000),
                               static_cast<std::int64_t>(i * 104729 % 40000),
                               static_cast<std::int64_t>(i % 500)};
        points.setValue<std::uint8_t>(classification, i, static_cast<std::uint8_t>(i % 11));
    }
    auto writer = las::Writer::create(folder.file("in.las"), options);
    REQUIRE(writer.ok());
    REQUIRE((*writer)->write(points).ok());
    REQUIRE((*writer)->finish().ok());
    REQUIRE(convertFiles({folder.file("in.las")}, folder.file("c.stipple"), {}, [](auto&&...) {}).ok());
    ApiFixture api(folder.file("c.stipple"));
    auto found = [&](const char* query) {
        ApiAnswer answer = api.ask(cat("/api/v1/clouds/c/points?", query));
        REQUIRE(answer.status == 200);
        LasAnswer las = lasOf(answer.body);
        Records records;
        PointBatch columns = las.columnsOf(options.schema);
        for (std::size_t i = 0; i < columns.size(); ++i)
            addRecord(records, options.schema, columns, i);
        std::sort(records.begin(), records.end());
        return records;
    };
    auto expected = [&](auto holds) {
        Records records;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (holds(i % 11))
                addRecord(records, options.schema, points, i);
        std::sort(records.begin(), records.end());
        return records;
    };
    CHECK((found("class=2") == expected([](std::size_t c) { return c == 2; })));
    CHECK((found("class=2,6-8") == expected([](std::size_t c) { return c == 2 || (c >= 6 && c <= 8); })));
    CHECK((found("class=0-5&where=Classification:4..9") ==
           expected([](std::size_t c) { return c == 4 || c == 5; })));
    CHECK(found("class=200").empty());
}

TEST_CASE("regions of autzen are those of the scan, every attribute of every point", "[slow]") {
    STIPPLE_NEEDS_DATA();
    const std::string scan = dataPath("clouds/autzen.laz");
    TemporaryFolder folder;
    auto converted = convertFiles({scan}, folder.file("autzen.stipple"), {}, [](auto&&...) {});
    REQUIRE(converted.ok());
    auto source = openFileSource(scan);
    REQUIRE(source.ok());
    auto reader = las::Reader::open(**source);
    REQUIRE(reader.ok());
    const Schema& schema = (*reader)->schema();
    auto intensity = static_cast<std::size_t>(schema.find("Intensity"));
    auto classification = static_cast<std::size_t>(schema.find("Classification"));
    std::vector<Region> all = regions();
    std::vector<Records> expected(all.size());
    PointBatch batch;
    for (std::uint64_t first = 0; first < (*reader)->pointCount(); first += 500'000) {
        REQUIRE((*reader)->read(first, 500'000, batch).ok());
        for (std::size_t i = 0; i < batch.size(); ++i)
            for (std::size_t r = 0; r < all.size(); ++r)
                if (all[r].holds((*reader)->header().grid.toWorld(batch.positions[i]),
                                 batch.value<std::uint16_t>(static_cast<int>(intensity), i),
                                 batch.columns[classification][i]))
                    addRecord(expected[r], schema, batch, i);
    }
    ApiFixture api(folder.file("autzen.stipple"));
    for (std::size_t r = 0; r < all.size(); ++r) {
        std::sort(expected[r].begin(), expected[r].end());
        for (const char* format : {"las", "laz"}) {
            ApiAnswer answer = api.ask(cat("/api/v1/clouds/autzen/", all[r].isProfile ? "profile" : "points",
                                           "?", all[r].query, "&format=", format));
            INFO(all[r].name << ", " << format << ": "
                             << answer.body.substr(0, answer.status == 200 ? 0 : 300));
            REQUIRE(answer.status == 200);
            LasAnswer las = lasOf(answer.body);
            CHECK(las.header.grid == (*reader)->header().grid);
            PointBatch points = las.columnsOf(schema);
            Records found;
            for (std::size_t i = 0; i < points.size(); ++i)
                addRecord(found, schema, points, i);
            std::sort(found.begin(), found.end());
            CHECK(expected[r].size() > 10'000);
            CHECK(found.size() == expected[r].size());
            REQUIRE((found == expected[r]));
        }
    }
}
