#include "server/api/batch_endpoint.hpp"
#include "shared/base/bytes.hpp"
#include "shared/base/text.hpp"
#include "tests/unit/server/api/api_fixture.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::server;
using namespace stipple::test;

namespace {

const std::string path = "/api/v1/clouds/small/nodes";

struct Frame {
    std::uint32_t status = 0;
    NodeKey key;
    std::uint32_t strata = 0;
    std::string bytes;
};

std::vector<Frame> framesOf(const std::string& body) {
    std::vector<Frame> frames;
    ByteReader reader(ByteSpan(reinterpret_cast<const std::uint8_t*>(body.data()), body.size()));
    while (reader.remaining() > 0) {
        Frame frame;
        frame.status = reader.read<std::uint32_t>();
        frame.key.level = static_cast<std::uint8_t>(reader.read<std::uint32_t>());
        frame.key.x = reader.read<std::uint32_t>();
        frame.key.y = reader.read<std::uint32_t>();
        frame.key.z = reader.read<std::uint32_t>();
        frame.strata = reader.read<std::uint32_t>();
        ByteSpan bytes = reader.readBytes(static_cast<std::size_t>(reader.read<std::uint64_t>()));
        REQUIRE(reader.ok());
        frame.bytes.assign(bytes.begin(), bytes.end());
        frames.push_back(std::move(frame));
    }
    return frames;
}

} // namespace

TEST_CASE("a batch holds the nodes as each alone is answered, in the order asked for") {
    ApiFixture api;
    std::string keys;
    for (auto entry = api.cloud().nodes.rbegin(); entry != api.cloud().nodes.rend(); ++entry)
        keys += cat(keys.empty() ? "" : ",", entry->key.text());
    for (std::string more : {"", "&strata=2", "&attributes=Intensity", "&strata=1&attributes=none"}) {
        INFO(more);
        auto answer = api.ask(path + "?keys=" + keys + more);
        REQUIRE(answer.status == 200);
        CHECK(answer.field("Content-Type") == "application/vnd.stipple.nodes");
        auto frames = framesOf(answer.body);
        REQUIRE(frames.size() == api.cloud().nodes.size());
        for (std::size_t i = 0; i < frames.size(); ++i) {
            const NodeEntry& entry = api.cloud().nodes[frames.size() - 1 - i];
            CHECK(frames[i].status == 200);
            CHECK(frames[i].key == entry.key);
            CHECK((frames[i].bytes == api.ask(path + "/" + entry.key.text() + "?format=stored" + more).body));
        }
    }
}

TEST_CASE("each node of a batch may have strata of its own") {
    ApiFixture api;
    auto frames = framesOf(api.ask(path + "?keys=0-0-0-0:1,1-0-0-0,1-1-0-0:4&strata=3&attributes=none").body);
    REQUIRE(frames.size() == 3);
    const auto& nodes = api.cloud().nodes;
    CHECK(frames[0].strata == 1);
    CHECK(frames[0].bytes.size() == nodes[0].strataRange(1).size);
    CHECK(frames[1].strata == 3);
    CHECK(frames[1].bytes.size() == nodes[1].strataRange(3).size);
    CHECK(frames[2].strata == 4);
    CHECK(frames[2].bytes.size() == nodes[2].strataRange(4).size);
}

TEST_CASE("a node that there is not is a frame without bytes, and the others are there") {
    ApiFixture api;
    for (int i = 0; i < 2; ++i) { // the hierarchy is read, then known
        auto frames = framesOf(api.ask(path + "?keys=0-0-0-0,9-5-5-5,1-0-0-0").body);
        REQUIRE(frames.size() == 3);
        CHECK(frames[1].status == 404);
        CHECK(frames[1].key == NodeKey{9, 5, 5, 5});
        CHECK(frames[1].bytes.empty());
        CHECK(frames[2].status == 200);
    }
}

TEST_CASE("what a batch can't be asked for is refused by name") {
    ApiFixture api;
    auto refused = [&](const std::string& query, const std::string& parameter) {
        auto answer = api.ask(path + query);
        INFO(query);
        CHECK(answer.status == 400);
        CHECK(answer.json["parameter"] == parameter);
    };
    refused("", "keys");
    refused("?keys=", "keys");
    refused("?keys=0-0-0-0,", "keys");
    refused("?keys=0-0-0-0:0", "keys");
    refused("?keys=0-0-0-0:5", "keys");
    refused("?keys=0-0-0-0:22", "keys");
    refused("?keys=0-0-0-0:", "keys");
    refused("?keys=0-0-0-0&strata=7", "strata");
    refused("?keys=0-0-0-0&format=json", "format");
    std::string many = "0-0-0-0";
    for (std::size_t i = 0; i < maxBatchKeys; ++i)
        many += ",0-0-0-0";
    refused("?keys=" + many, "keys");
}

TEST_CASE("a batch of more bytes than an answer may have is refused") {
    SmallCloudOptions options;
    options.levels = 1;
    options.pointsPerNode = 60'000;
    ApiFixture api(options);
    std::uint64_t times = maxBatchBytes / api.cloud().nodes[0].sizeBytes() + 1;
    REQUIRE(times <= maxBatchKeys);
    std::string keys = "0-0-0-0";
    for (std::uint64_t i = 1; i < times; ++i)
        keys += ",0-0-0-0";
    auto answer = api.ask(path + "?keys=" + keys);
    CHECK(answer.status == 400);
    CHECK(answer.json["type"] == "/api/v1/problems/work-too-large");
}

TEST_CASE("a batch has a tag of its own") {
    ApiFixture api;
    std::string tag = api.ask(path + "?keys=0-0-0-0,1-0-0-0").field("ETag");
    CHECK(api.ask(path + "?keys=0-0-0-0:4,1-0-0-0:4").field("ETag") == tag);
    CHECK(api.ask(path + "?keys=1-0-0-0,0-0-0-0").field("ETag") != tag);
    CHECK(api.ask(path + "?keys=0-0-0-0,1-0-0-0", {{"If-None-Match", tag}}).status == 304);
    CHECK(api.ask(path + "?keys=0-0-0-0&version=" + api.version()).field("Cache-Control") ==
          "public, max-age=31536000, immutable");
}
