#include "server/api/hierarchy_cache.hpp"
#include "tests/unit/server/api/api_fixture.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::server;
using namespace stipple::test;

TEST_CASE("keys of nodes are read as they are written, and nothing else is") {
    for (NodeKey key : {NodeKey{}, NodeKey{1, 0, 1, 0}, NodeKey{31, 2147483647u, 0, 17}})
        CHECK(nodeKeyFromText(key.text()) == key);
    for (auto text : {"",
                      "0",
                      "0-0-0",
                      "0-0-0-0-0",
                      "0-0-0-1",
                      "1-2-0-0",
                      "32-0-0-0",
                      "00-0-0-0",
                      "1-01-0-0",
                      "1-+1-0-0",
                      "1- 1-0-0",
                      "1--1-0-0",
                      "0x0-0-0-0",
                      "1-1-1-",
                      "-1-0-0-0",
                      "31-4294967296-0-0",
                      "31-99999999999999999999-0-0",
                      "1-1-0-0 ",
                      "r",
                      "1-1-1-1\n"}) {
        INFO(text);
        CHECK_FALSE(nodeKeyFromText(text).has_value());
    }
}

TEST_CASE("the hierarchy says where each node's bytes are") {
    ApiFixture api;
    auto answer = api.ask("/api/v1/clouds/small/hierarchy/0-0-0-0");
    REQUIRE(answer.status == 200);
    CHECK(answer.field("Content-Type") == "application/json");
    CHECK(answer.json["key"] == "0-0-0-0");
    CHECK(answer.json["version"] == api.ask("/api/v1/clouds/small").json["version"]);
    const auto& nodes = answer.json["nodes"];
    REQUIRE(nodes.size() == api.cloud().nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const NodeEntry& entry = api.cloud().nodes[i];
        CHECK(nodes[i]["key"] == entry.key.text());
        CHECK(nodes[i]["childMask"] == entry.childMask);
        CHECK(nodes[i]["pointCount"] == entry.pointCount);
        CHECK(nodes[i]["offset"] == entry.offsetBytes);
        CHECK(nodes[i]["strataBytes"] == entry.strataBytes);
        CHECK(nodes[i]["attributeBytes"] == entry.attributeBytes);
        CHECK(nodes[i]["childChunk"].is_null());
    }
    CHECK(answer.json["attributeBlocks"] == nlohmann::json{{"Intensity"}, {"Point Source ID"}});
}

TEST_CASE("a node of the hierarchy has the cube and the spacing of its level") {
    SmallCloudOptions options;
    options.grid = {{0.5, 0.5, 0.25}, {100, 200, 300}};
    ApiFixture api(options);
    auto nodes = api.ask("/api/v1/clouds/small/hierarchy/1-1-0-0").json["nodes"];
    double half = 0.5 * 65536;
    CHECK(nodes[0]["key"] == "1-1-0-0");
    CHECK(nodes[0]["bounds"]["min"] == nlohmann::json{100 + half, 200, 300});
    CHECK(nodes[0]["bounds"]["max"] == nlohmann::json{100 + 2 * half, 200 + half, 300 + half / 2});
    CHECK(nodes[0]["spacing"] == api.cloud().metadata.spacing / 2);
    for (const auto& node : nodes)
        CHECK(node["key"].get<std::string>() >= "1-1-0-0");
    CHECK(nodes.size() == 5); // itself and its four children
}

TEST_CASE("a chunk of its own is read when it is asked for") {
    SmallCloudOptions options;
    options.levels = 6; // 1365 nodes: more than one chunk holds
    options.pointsPerNode = 8;
    ApiFixture api(options);
    auto root = api.ask("/api/v1/clouds/small/hierarchy/0-0-0-0").json["nodes"];
    REQUIRE(root.size() < api.cloud().nodes.size());
    std::size_t seen = root.size();
    for (const auto& node : root) {
        if (node["childChunk"].is_null())
            continue;
        auto below =
            api.ask("/api/v1/clouds/small/hierarchy/" + node["key"].get<std::string>()).json["nodes"];
        REQUIRE(below.size() > 1);
        CHECK(below[0] == node);
        seen += below.size() - 1;
    }
    CHECK(seen == api.cloud().nodes.size());
}

TEST_CASE("nodes that there are not, and keys that are none, are told apart") {
    ApiFixture api;
    for (auto key : {"1-0-0-1", "5-0-0-0", "31-2147483647-0-0"}) { // the small cloud has lower children only
        auto answer = api.ask(std::string("/api/v1/clouds/small/hierarchy/") + key);
        CHECK(answer.status == 404);
        CHECK(answer.json["type"] == "/api/v1/problems/no-such-node");
    }
    auto answer = api.ask("/api/v1/clouds/small/hierarchy/root");
    CHECK(answer.status == 400);
    CHECK(answer.json["parameter"] == "key");
}

TEST_CASE("an address with the version is immutable, and gone with the version") {
    ApiFixture api;
    std::string path = "/api/v1/clouds/small/hierarchy/0-0-0-0", version = api.version();
    auto open = api.ask(path), versioned = api.ask(path + "?version=" + version);
    CHECK(open.field("Cache-Control") == "no-cache");
    CHECK(versioned.field("Cache-Control") == "public, max-age=31536000, immutable");
    CHECK(open.field("ETag") == versioned.field("ETag"));
    auto gone = api.ask(path + "?version=1-2-3");
    CHECK(gone.status == 410);
    CHECK(gone.json["type"] == "/api/v1/problems/version-gone");
    CHECK(gone.json["parameter"] == "version");
}

TEST_CASE("conditions are answered without the body, but only of what there is") {
    ApiFixture api;
    std::string path = "/api/v1/clouds/small/hierarchy/0-0-0-0", tag = api.ask(path).field("ETag");
    CHECK(tag.size() > 4);
    auto notModified = api.ask(path, {{"If-None-Match", tag}});
    CHECK(notModified.status == 304);
    CHECK(notModified.body.empty());
    CHECK(notModified.field("ETag") == tag);
    CHECK(api.ask(path, {{"If-Match", "\"other\""}}).status == 412);
    CHECK(api.ask("/api/v1/clouds/small/hierarchy/9-0-0-0", {{"If-None-Match", "*"}}).status == 404);
    CHECK(api.ask("/api/v1/clouds/small/hierarchy/1-0-0-0", {{"If-None-Match", tag}}).status == 200);
}
