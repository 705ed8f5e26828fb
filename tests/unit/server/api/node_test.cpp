#include "tests/unit/server/api/api_fixture.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::server;
using namespace stipple::test;

namespace {

std::string bytesOf(const ApiFixture& api, ByteRange range) {
    auto from = api.cloud().file.begin() + static_cast<std::ptrdiff_t>(range.offset);
    return std::string(from, from + static_cast<std::ptrdiff_t>(range.size));
}

const std::string path = "/api/v1/clouds/small/nodes/";

} // namespace

TEST_CASE("a node as stored is the very bytes of the file") {
    ApiFixture api;
    for (const NodeEntry& entry : api.cloud().nodes) {
        auto answer = api.ask(path + entry.key.text());
        CHECK(answer.status == 200);
        CHECK(answer.field("Content-Type") == "application/octet-stream");
        CHECK((answer.body == bytesOf(api, {entry.offsetBytes, entry.sizeBytes()})));
    }
}

TEST_CASE("strata and attributes choose blocks") {
    ApiFixture api;
    const NodeEntry& entry = api.cloud().nodes[1];
    std::string node = path + entry.key.text();
    for (int strata = 1; strata <= 4; ++strata) {
        std::string picture = bytesOf(api, entry.strataRange(strata));
        std::string intensity = bytesOf(api, entry.attributeRange(0));
        std::string source = bytesOf(api, entry.attributeRange(1));
        std::string query = "?strata=" + std::to_string(strata);
        auto isAnswered = [&](const std::string& attributes, const std::string& bytes) {
            INFO(query << attributes);
            CHECK((api.ask(node + query + attributes).body == bytes));
        };
        isAnswered("&attributes=none", picture);
        isAnswered("&attributes=Red,Green", picture); // they are in the strata
        isAnswered("&attributes=intensity,Red", picture + intensity);
        isAnswered("&attributes=Point%20Source%20ID", picture + source);
        isAnswered("&attributes=Point+Source+ID,Intensity", picture + intensity + source);
        isAnswered("", picture + intensity + source);
    }
}

TEST_CASE("the first request of a node and later ones answer the same") {
    ApiFixture api;
    auto first = api.ask(path + "1-0-0-0"); // the hierarchy has to be read first
    auto second = api.ask(path + "1-0-0-0");
    CHECK((first.body == second.body));
    CHECK(first.response.fields == second.response.fields);
}

TEST_CASE("parts of nodes have tags of their own, however they are asked for") {
    ApiFixture api;
    std::string node = path + "1-0-0-0";
    std::string whole = api.ask(node).field("ETag");
    CHECK(api.ask(node + "?strata=4").field("ETag") == whole);
    CHECK(api.ask(node + "?strata=3").field("ETag") != whole);
    CHECK(api.ask(node + "?attributes=none").field("ETag") != whole);
    CHECK(api.ask(path + "1-1-0-0").field("ETag") != whole);
    CHECK(api.ask(node, {{"If-None-Match", whole}}).status == 304);
    CHECK(api.ask(node + "?strata=3", {{"If-None-Match", whole}}).status == 200);
}

TEST_CASE("what a node can't be asked for is refused by name") {
    ApiFixture api;
    auto refused = [&](const std::string& target, int status, const std::string& parameter) {
        auto answer = api.ask(path + target);
        INFO(target);
        CHECK(answer.status == status);
        CHECK(answer.field("Content-Type") == "application/problem+json");
        CHECK(answer.json.value("parameter", "") == parameter);
    };
    refused("0-0-0-0?strata=0", 400, "strata");
    refused("0-0-0-0?strata=5", 400, "strata");
    refused("0-0-0-0?strata=1.0", 400, "strata");
    refused("0-0-0-0?strata=", 400, "strata");
    refused("0-0-0-0?strata=1&strata=1", 400, "strata");
    refused("0-0-0-0?attributes=Height", 400, "attributes");
    refused("0-0-0-0?format=tiff", 400, "format");
    refused("0-0-0-0?Strata=1", 400, "Strata");
    refused("0-0-0-9", 400, "key");
    refused("4-0-0-0", 404, "");
}

TEST_CASE("a node in a format that there is not is 406") {
    ApiFixture api;
    auto answer = api.ask(path + "0-0-0-0", {{"Accept", "image/tiff"}});
    CHECK(answer.status == 406);
    CHECK(answer.json["available"].size() >= 2);
    CHECK(answer.field("Vary") == "Accept");
    CHECK(api.ask(path + "0-0-0-0").field("Vary") == "Accept");
    CHECK(api.ask(path + "0-0-0-0?format=stored", {{"Accept", "image/tiff"}}).field("Vary").empty());
}
