// Files, profiles and volumes of regions, from a cloud's nodes, against all of its points tested one by one.
#include "client/region/region_work.hpp"

#include "shared/format/cloud_file.hpp"
#include "shared/geometry/plan_polygon.hpp"
#include "shared/io/memory_source.hpp"
#include "shared/las/las_reader.hpp"
#include "shared/select/region_json.hpp"
#include "tests/support/small_cloud.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

using namespace stipple;
using namespace stipple::test;
using nlohmann::json;

namespace {

const SmallCloud& town() {
    static SmallCloud cloud = makeSmallCloud({.levels = 4,
                                              .pointsPerNode = 500,
                                              .grid = {{0.25, 0.25, 0.25}, {500000, 4000000, 0}},
                                              .rootCube = {{-300, -200, 0}, 12}});
    return cloud;
}

std::shared_ptr<const CloudMetadata> metadata() {
    return std::make_shared<const CloudMetadata>(town().metadata);
}

template <class T>
T need(Result<T> result) {
    if (!result.ok())
        FAIL(result.error().sentence());
    return std::move(result).value();
}

// What a scan would hand over.
struct Made {
    json answer;
    Bytes file;
};
Made make(const json& request) {
    auto work = need(RegionWork::make(metadata(), request));
    PointFilter region = need(regionFromJson(work->scan()["region"], "region"));
    auto filter = need(CloudFilter::make(town().metadata, region));
    MemorySource source(town().file);
    auto reader = need(CloudReader::open(source));
    Made made;
    auto takePiece = [&] {
        Bytes piece = work->pieces().take();
        made.file.insert(made.file.end(), piece.begin(), piece.end());
    };
    for (const NodeEntry& entry : town().nodes) {
        CloudFilter::Verdict verdict = filter.verdictOn(entry);
        bool tested = verdict == CloudFilter::Verdict::tested;
        if (!tested && verdict != CloudFilter::Verdict::whole)
            continue;
        Status taken = work->take(need(reader->fetchNode(entry, work->attributesToRead(tested))), tested);
        if (!taken.ok())
            FAIL(taken.error().sentence());
        takePiece();
    }
    made.answer = need(work->finish());
    takePiece();
    for (const auto& [offset, bytes] : work->pieces().patches)
        std::copy(bytes.begin(), bytes.end(), made.file.begin() + static_cast<std::ptrdiff_t>(offset));
    return made;
}

struct AllPoints {
    std::vector<Vec3i> steps;
    std::vector<Vec3d> places;
    PointBatch batch;
};
const AllPoints& all() {
    static AllPoints points = [] {
        AllPoints made;
        made.batch.resize(town().metadata.schema, 0);
        MemorySource source(town().file);
        auto reader = need(CloudReader::open(source));
        for (const NodeEntry& entry : town().nodes) {
            PointBatch batch = need(reader->readNode(entry));
            for (Vec3i position : batch.positions) {
                made.steps.push_back(position);
                made.places.push_back(town().metadata.grid.toWorld(position));
            }
            for (std::size_t a = 0; a < batch.columns.size(); ++a)
                made.batch.columns[a].insert(made.batch.columns[a].end(), batch.columns[a].begin(),
                                             batch.columns[a].end());
        }
        return made;
    }();
    return points;
}

const json box{{"box", {{"centre", {500200, 4000300, 100}}, {"halfSize", {150, 200, 90}}}}};
bool inBox(Vec3d p) {
    return std::abs(p.x - 500200) <= 150 && std::abs(p.y - 4000300) <= 200 && std::abs(p.z - 100) <= 90;
}

// Integers and the values of attribute `name`.
using Row = std::array<std::int64_t, 4>;
std::vector<Row> rowsInside(const char* name) {
    int a = town().metadata.schema.find(name);
    std::vector<Row> rows;
    for (std::size_t i = 0; i < all().steps.size(); ++i)
        if (inBox(all().places[i]))
            rows.push_back({all().steps[i].x, all().steps[i].y, all().steps[i].z,
                            all().batch.value<std::uint16_t>(a, i)});
    std::sort(rows.begin(), rows.end());
    return rows;
}

} // namespace

TEST_CASE("the points of a region as LAS and LAZ are those of the cloud that lie in it") {
    std::vector<Row> expected = rowsInside("Red");
    REQUIRE(expected.size() > 1000);
    for (const char* format : {"las", "laz"}) {
        Made made = make({{"make", "file"}, {"format", format}, {"region", box}});
        CHECK(made.answer["points"] == expected.size());
        CHECK(made.answer["bytes"] == made.file.size());
        MemorySource source(made.file);
        auto reader = need(las::Reader::open(source));
        PointBatch points;
        REQUIRE(reader->read(0, reader->pointCount(), points).ok());
        int red = reader->schema().find("Red");
        REQUIRE(red >= 0);
        std::vector<Row> rows;
        for (std::size_t i = 0; i < points.size(); ++i)
            rows.push_back({points.positions[i].x, points.positions[i].y, points.positions[i].z,
                            points.value<std::uint16_t>(red, i)});
        std::sort(rows.begin(), rows.end());
        CHECK(rows == expected);
        CHECK(reader->header().grid.offset.x == 500000);
    }
}

TEST_CASE("the points of a region as CSV, with the attributes asked for alone") {
    Made made = make({{"make", "file"}, {"format", "csv"}, {"region", box}, {"attributes", {"Intensity"}}});
    std::istringstream text(std::string(made.file.begin(), made.file.end()));
    std::string line;
    std::getline(text, line);
    CHECK(line == "X,Y,Z,Intensity");
    std::vector<Row> rows;
    while (std::getline(text, line)) {
        double x = 0, y = 0, z = 0;
        int value = 0;
        REQUIRE(std::sscanf(line.c_str(), "%lf,%lf,%lf,%d", &x, &y, &z, &value) == 4);
        rows.push_back({static_cast<std::int64_t>((x - 500000) * 4),
                        static_cast<std::int64_t>((y - 4000000) * 4), static_cast<std::int64_t>(z * 4),
                        value});
    }
    std::sort(rows.begin(), rows.end());
    CHECK(rows == rowsInside("Intensity"));
}

TEST_CASE("files of a corridor have stations and offsets, and so has a profile") {
    json line{{"line", {{499990, 4000100}, {500700, 4000400}}}, {"width", 40}};
    Made csv = make({{"make", "file"}, {"format", "csv"}, {"region", line}, {"attributes", json::array()}});
    std::istringstream text(std::string(csv.file.begin(), csv.file.end()));
    std::string row;
    std::getline(text, row);
    CHECK(row == "X,Y,Z,Station,Offset");
    std::vector<std::array<double, 5>> rows;
    while (std::getline(text, row)) {
        std::array<double, 5> numbers{};
        REQUIRE(std::sscanf(row.c_str(), "%lf,%lf,%lf,%lf,%lf", &numbers[0], &numbers[1], &numbers[2],
                            &numbers[3], &numbers[4]) == 5);
        rows.push_back(numbers);
    }
    REQUIRE(rows.size() > 500);
    Made profile = make({{"make", "profile"}, {"region", line}});
    CHECK(profile.answer["points"] == rows.size());
    std::size_t at = 0, row0 = 0;
    ByteReader in(profile.file);
    while (in.remaining() > 0) {
        std::uint32_t count = in.read<std::uint32_t>();
        in.read<std::uint32_t>();
        std::vector<std::array<double, 5>> batch(count);
        for (std::size_t column : {3u, 4u, 0u, 1u, 2u})
            for (auto& numbers : batch)
                numbers[column] = in.read<double>();
        for (auto& numbers : batch)
            CHECK(numbers == rows[row0++]);
        for (std::uint32_t i = 0; i < count; ++i)
            CHECK((in.read<std::uint32_t>() >> 24) == 0xff);
        for (std::uint32_t i = 0; i < count; ++i)
            CHECK(in.read<std::uint32_t>() == 0); // the cloud has no classes and returns
        for (std::uint32_t i = 0; i < count; ++i)
            CHECK(in.read<float>() >= 0);
        ++at;
    }
    CHECK(in.ok());
    CHECK(at > 1);
    CHECK(row0 == rows.size());
}

TEST_CASE("a volume counts the points inside its polygon, above and below its base") {
    auto corner = [](std::int64_t x, std::int64_t y, std::int64_t z) {
        return json{{"integers", {x, y, z}},
                    {"scale", {0.25, 0.25, 0.25}},
                    {"offset", {500000, 4000000, 0}},
                    {"spacing", 0.5}};
    };
    json corners{corner(0, 0, 400), corner(2000, 100, 500), corner(900, 900, 450), corner(1800, 2200, 600)};
    json request{{"make", "volume"}, {"points", corners}, {"base", {{"height", 110}}}, {"cell", 500}};
    Made level = make(request);
    // The cells' mean heights, by hand: one cell of 500 units is as wide as the polygon, so all is one mean.
    CHECK(level.answer["cut"].get<double>() >= 0);
    CHECK(level.answer["net"].get<double>() ==
          Approx(level.answer["cut"].get<double>() - level.answer["fill"].get<double>()));
    std::vector<Point2d> ring{{500000, 4000000}, {500500, 4000025}, {500225, 4000225}, {500450, 4000550}};
    Ring polygon(ring);
    std::size_t inside = 0;
    for (Vec3d p : all().places)
        inside += polygon.sideOf({p.x, p.y}) != Ring::Side::outside;
    REQUIRE(inside > 1000);
    CHECK(level.answer["pointsInside"] == inside);
    double area = level.answer["area"].get<double>();
    CHECK(area == Approx(std::abs(signedArea(ring))).epsilon(1e-12));
    // A base that is one higher has its area less of net volume, whatever the cells are.
    request["base"] = {{"height", 111}};
    CHECK(make(request).answer["net"].get<double>() ==
          Approx(level.answer["net"].get<double>() - area).epsilon(1e-9));
    // A base at a picked point is one at its height, but for what the point may be off by.
    request["base"] = {{"point", corner(77, 88, 444)}};
    Made picked = make(request);
    CHECK(picked.answer["net"].get<double>() ==
          Approx(make({{"make", "volume"}, {"points", corners}, {"base", {{"height", 111}}}, {"cell", 500}})
                     .answer["net"]
                     .get<double>()));
    CHECK(picked.answer["±net"].get<double>() > level.answer["±net"].get<double>());
    // Cells are chosen by how near points are.
    request.erase("cell");
    request["base"] = "rim";
    json rim = make(request).answer;
    CHECK(rim["cell"].get<double>() == Approx(2 * std::sqrt(area / static_cast<double>(inside))));
    CHECK(rim["±cut"].get<double>() > 0);
    CHECK(rim["area"].get<double>() == Approx(area).epsilon(1e-9));
}

TEST_CASE("the points of a region are counted, and nothing is read of them but where they are") {
    auto work = need(RegionWork::make(metadata(), {{"make", "count"}, {"region", box}}));
    CHECK(work->attributesToRead(true).empty());
    CHECK(make({{"make", "count"}, {"region", box}}).answer["points"] == rowsInside("Red").size());
    CHECK(make({{"make", "count"}, {"region", json::object()}}).answer["points"] == all().steps.size());
}

TEST_CASE("what can't be made is said before anything is read") {
    auto refused = [](const json& request) {
        auto work = RegionWork::make(metadata(), request);
        INFO(request.dump());
        REQUIRE_FALSE(work.ok());
        CHECK(work.error().code == ErrorCode::invalidArgument);
    };
    refused(json::array());
    refused({{"make", 7}});
    refused({{"make", "coffee"}});
    refused({{"make", "file"}, {"format", "doc"}, {"region", box}});
    refused({{"make", "file"}, {"format", "csv"}, {"region", box}, {"attributes", {"Beauty"}}});
    refused({{"make", "file"}, {"format", "csv"}, {"region", box}, {"attributes", "all"}});
    refused({{"make", "file"}, {"format", "csv"}, {"region", box}, {"mostPoints", "many"}});
    refused({{"make", "file"}, {"format", "csv"}, {"region", {{"box", 3}}}});
    refused({{"make", "profile"}, {"region", box}});
    refused({{"make", "volume"}, {"points", json::array()}});
    auto limited = need(RegionWork::make(
        metadata(), {{"make", "file"}, {"format", "csv"}, {"region", json::object()}, {"mostPoints", 700u}}));
    MemorySource source(town().file);
    auto reader = need(CloudReader::open(source));
    auto node = [&](std::size_t i) {
        return need(reader->fetchNode(town().nodes[i], limited->attributesToRead(false)));
    };
    CHECK(limited->take(node(0), false).ok());
    Status over = limited->take(node(1), false);
    REQUIRE_FALSE(over.ok());
    CHECK(over.error().code == ErrorCode::limitExceeded);
}
