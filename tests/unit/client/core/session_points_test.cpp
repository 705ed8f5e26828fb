#include "client/core/view_session.hpp"

#include "shared/format/cloud_file.hpp"
#include "shared/io/memory_source.hpp"
#include "tests/support/session_fixture.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::test;

TEST_CASE("every point of a picture can be asked for, exactly and with all attributes") {
    SmallCloud cloud = makeSmallCloud({.levels = 3, .pointsPerNode = 500, .innerColour = InnerColour::mean});
    SessionFixture fixture(everything());
    fixture.openAndFit(cloud);
    REQUIRE(fixture.settle());
    MemorySource source(cloud.file);
    auto reader = CloudReader::open(source);
    REQUIRE(reader.ok());
    CloudId id = fixture.session->clouds()[0].id;
    std::size_t asked = 0;
    for (const DrawNode& node : fixture.session->plan().nodes)
        for (std::uint32_t index : {0u, 17u, 499u}) {
            REQUIRE(fixture.session->askPoint({id, node.node->key, index}).ok());
            ++asked;
        }
    CHECK(fixture.session->pointsPending());
    REQUIRE(fixture.settle());
    std::vector<PointAnswer> answers = fixture.session->takePointAnswers();
    REQUIRE(answers.size() == asked);
    CHECK_FALSE(fixture.session->pointsPending());
    CHECK(fixture.session->takePointAnswers().empty());
    for (const PointAnswer& answer : answers) {
        REQUIRE(answer.record.ok());
        const NodeEntry& entry = nodeOf(cloud, answer.point.node.text());
        PointBatch points = *(*reader)->readNode(entry);
        std::size_t i = answer.point.index;
        CHECK(answer.record->integers == points.positions[i]);
        CHECK(answer.record->position == cloud.metadata.grid.toWorld(points.positions[i]));
        REQUIRE(answer.record->values.size() == points.columns.size());
        for (std::size_t a = 0; a < points.columns.size(); ++a)
            CHECK(std::get<std::uint64_t>(answer.record->values[a].stored[0]) ==
                  points.value<std::uint16_t>(static_cast<int>(a), i));
    }
}

TEST_CASE("questions about points that are not there are refused, those of a closed cloud answered") {
    SessionFixture fixture(everything());
    auto script = fixture.openAndFit(bigCloud());
    CloudId id = fixture.session->clouds()[0].id;
    CHECK_FALSE(fixture.session->askPoint({id, NodeKey{}, 0}).ok()); // not open yet
    REQUIRE(fixture.settle());
    CHECK_FALSE(fixture.session->askPoint({id + 1, NodeKey{}, 0}).ok());
    CHECK_FALSE(fixture.session->askPoint({id, NodeKey{9, 1, 1, 1}, 0}).ok());
    CHECK_FALSE(fixture.session->askPoint({id, NodeKey{}, 20000}).ok());
    script->holdAnswers = true;
    REQUIRE(fixture.session->askPoint({id, NodeKey{}.child(0), 5}).ok());
    fixture.session->update();
    CHECK(fixture.session->takePointAnswers().empty());
    fixture.session->removeCloud(id);
    std::vector<PointAnswer> answers = fixture.session->takePointAnswers();
    REQUIRE(answers.size() == 1);
    CHECK(answers[0].record.error().code == ErrorCode::cancelled);
}

TEST_CASE("a node whose points can't be read answers with the error, and stays drawn") {
    SessionLimits limits = everything();
    limits.compressedBytes = 0; // else it would be read from what is here
    SessionFixture fixture(limits);
    auto script = fixture.openAndFit(bigCloud());
    REQUIRE(fixture.settle());
    std::uint64_t drawn = fixture.pointsDrawn();
    NodeKey key = NodeKey{}.child(1);
    const NodeEntry& entry = nodeOf(bigCloud(), key.text());
    for (std::uint64_t at = 0; at < 64; ++at)
        script->file[static_cast<std::size_t>(entry.offsetBytes + at)] ^= 0x5A;
    REQUIRE(fixture.session->askPoint({fixture.session->clouds()[0].id, key, 5}).ok());
    REQUIRE(fixture.settle());
    std::vector<PointAnswer> answers = fixture.session->takePointAnswers();
    REQUIRE(answers.size() == 1);
    REQUIRE_FALSE(answers[0].record.ok());
    CHECK(answers[0].record.error().sentence().find(key.text()) != std::string::npos);
    CHECK(fixture.pointsDrawn() == drawn);
}
