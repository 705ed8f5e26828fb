// Decoded nodes against the points that the file's own reader gives.
#include "shared/base/text.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/memory_source.hpp"
#include "shared/las/las_reader.hpp"
#include "tests/unit/server/api/api_fixture.hpp"

#include <catch2/catch.hpp>

#include <sstream>

using namespace stipple;
using namespace stipple::server;
using namespace stipple::test;

namespace {

const std::string path = "/api/v1/clouds/small/nodes/";

SmallCloudOptions centimetres() {
    SmallCloudOptions options;
    options.grid = {{0.01, 0.01, 0.01}, {500000, 4000000, 100}};
    return options;
}

PointBatch pointsOf(const SmallCloud& cloud, const NodeEntry& entry) {
    MemorySource source(cloud.file);
    auto reader = CloudReader::open(source);
    REQUIRE(reader.ok());
    auto points = (*reader)->readNode(entry);
    REQUIRE(points.ok());
    return *points;
}

std::string decimalText(std::int64_t hundredths) {
    std::string digits = std::to_string(hundredths % 100);
    return cat(hundredths / 100, ".", digits.size() < 2 ? "0" : "", digits);
}

Bytes bytesOf(const std::string& text) {
    return Bytes(text.begin(), text.end());
}

} // namespace

TEST_CASE("a node as JSON holds its points in progressive order, with exact decimals") {
    ApiFixture api(centimetres());
    const NodeEntry& entry = api.cloud().nodes[2];
    PointBatch points = pointsOf(api.cloud(), entry);
    auto answer = api.ask(path + entry.key.text() + "?format=json");
    REQUIRE(answer.status == 200);
    CHECK(answer.field("Content-Type") == "application/json");
    CHECK(answer.json["key"] == entry.key.text());
    CHECK(answer.json["pointCount"] == entry.pointCount);
    CHECK(answer.json["strata"] == 4);
    CHECK(answer.json["version"] == api.version());
    CHECK(answer.json["columns"] ==
          nlohmann::json({"X", "Y", "Z", "Intensity", "Point Source ID", "Red", "Green", "Blue"}));
    REQUIRE(answer.json["points"].size() == points.size());
    const Schema& schema = api.cloud().metadata.schema;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto& row = answer.json["points"][i];
        Vec3d world = api.cloud().metadata.grid.toWorld(points.positions[i]);
        REQUIRE(row.size() == 8);
        CHECK(row[0].get<double>() == Approx(world.x).epsilon(0).margin(1e-9));
        CHECK(row[3] == points.value<std::uint16_t>(schema.find("Intensity"), i));
        CHECK(row[6] == points.value<std::uint16_t>(schema.find("Green"), i));
    }
    std::string first = cat("\n[", decimalText(points.positions[0].x + 50000000), ",");
    CHECK(answer.body.find(first) != std::string::npos);
}

TEST_CASE("strata are a prefix of the node, with every attribute") {
    ApiFixture api(centimetres());
    std::string node = path + "1-0-0-0?format=json";
    auto whole = api.ask(node).json["points"];
    for (int strata = 1; strata <= 4; ++strata) {
        auto part = api.ask(node + "&strata=" + std::to_string(strata)).json;
        std::size_t count = strataPrefixPoints(400, strata);
        CHECK(part["strata"] == strata);
        REQUIRE(part["points"].size() == count);
        for (std::size_t i = 0; i < count; ++i)
            CHECK(part["points"][i] == whole[i]);
    }
}

TEST_CASE("attributes come in the order in which they are asked for") {
    ApiFixture api;
    auto answer = api.ask(path + "0-0-0-0?format=json&attributes=Point+Source+ID,red&strata=1").json;
    CHECK(answer["columns"] == nlohmann::json({"X", "Y", "Z", "Point Source ID", "Red"}));
    CHECK(answer["points"][0].size() == 5);
    CHECK(api.ask(path + "0-0-0-0?format=json&attributes=none").json["columns"] ==
          nlohmann::json({"X", "Y", "Z"}));
}

TEST_CASE("CSV has the rows of JSON") {
    ApiFixture api(centimetres());
    auto json = api.ask(path + "1-1-0-0", {{"Accept", "application/json"}}).json;
    auto csv = api.ask(path + "1-1-0-0", {{"Accept", "text/csv"}});
    CHECK(csv.field("Content-Type") == "text/csv; charset=utf-8; header=present");
    CHECK(csv.field("Content-Disposition") == "attachment; filename=small-1-1-0-0.csv");
    CHECK(csv.field("Vary") == "Accept");
    std::istringstream lines(csv.body);
    std::string line;
    REQUIRE(std::getline(lines, line));
    CHECK(line == "X,Y,Z,Intensity,Point Source ID,Red,Green,Blue");
    std::size_t row = 0;
    for (; std::getline(lines, line); ++row)
        CHECK(nlohmann::json::parse("[" + line + "]") == json["points"][row]);
    CHECK(row == 400);
}

TEST_CASE("LAS and LAZ hold the exact integers and every attribute") {
    ApiFixture api(centimetres());
    const NodeEntry& entry = api.cloud().nodes[1];
    PointBatch points = pointsOf(api.cloud(), entry);
    const Schema& schema = api.cloud().metadata.schema;
    for (auto [format, type] : {std::pair{"las", "application/vnd.las"}, {"laz", "application/vnd.laszip"}}) {
        auto answer = api.ask(path + entry.key.text() + "?format=" + format);
        REQUIRE(answer.status == 200);
        CHECK(answer.field("Content-Type") == type);
        MemorySource source(bytesOf(answer.body));
        auto reader = las::Reader::open(source);
        REQUIRE(reader.ok());
        CHECK((*reader)->warnings().empty());
        PointBatch read;
        REQUIRE((*reader)->read(0, points.size() + 1, read).ok());
        REQUIRE(read.size() == points.size());
        const Grid& grid = (*reader)->header().grid;
        for (std::size_t i = 0; i < points.size(); ++i) {
            Vec3d expected = api.cloud().metadata.grid.toWorld(points.positions[i]);
            Vec3d world = grid.toWorld(read.positions[i]);
            CHECK(world.x == Approx(expected.x).epsilon(0).margin(1e-6));
            CHECK(world.z == Approx(expected.z).epsilon(0).margin(1e-6));
        }
        for (auto name : {"Intensity", "Red", "Green", "Blue", "Point Source ID"})
            CHECK(read.columns[static_cast<std::size_t>((*reader)->schema().find(name))] ==
                  points.columns[static_cast<std::size_t>(schema.find(name))]);
    }
}

TEST_CASE("PLY says how many points it holds") {
    ApiFixture api;
    auto answer = api.ask(path + "0-0-0-0?format=ply&strata=2");
    CHECK(answer.field("Content-Type") == "application/x-ply");
    CHECK(answer.body.starts_with("ply\nformat binary_little_endian 1.0\n"));
    CHECK(answer.body.find("element vertex 100\n") != std::string::npos);
}

TEST_CASE("each format has a tag of its own") {
    ApiFixture api;
    std::vector<std::string> tags;
    for (auto format : {"stored", "json", "csv", "las", "laz", "ply"}) {
        auto answer = api.ask(path + "0-0-0-0?format=" + format);
        CHECK(answer.status == 200);
        CHECK(std::find(tags.begin(), tags.end(), answer.field("ETag")) == tags.end());
        tags.push_back(answer.field("ETag"));
        auto again = api.ask(path + "0-0-0-0?format=" + format, {{"If-None-Match", tags.back()}});
        CHECK(again.status == 304);
        CHECK((api.ask(path + "0-0-0-0?format=" + format).body == answer.body));
    }
}

TEST_CASE("a damaged node is a problem of the cloud, without a path of this machine") {
    ApiFixture api;
    std::string text(api.cloud().file.begin(), api.cloud().file.end());
    text[static_cast<std::size_t>(api.cloud().nodes[0].offsetBytes) + 20] ^= 1;
    writeText(api.path(), text);
    auto answer = api.ask(path + "0-0-0-0?format=json");
    CHECK(answer.status == 503);
    CHECK(answer.json["type"] == "/api/v1/problems/cloud-unusable");
    CHECK(answer.body.find(api.path()) == std::string::npos);
    CHECK(api.ask(path + "1-0-0-0?format=json").status == 200); // the others are as they were
}
