#include "client/core/view_session.hpp"

#include "shared/format/file_parts.hpp"
#include "shared/io/memory_source.hpp"
#include "tests/support/session_fixture.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::test;

namespace {

// Decodes as workers do, later: what is asked for about points waits until `holds` is false.
class HoldingDecoder final : public NodeDecoder {
  public:
    bool holds = false;
    std::size_t jobsForPoints = 0;

    void decode(DecodeJob job, Completion done) override {
        if (!job.points.empty())
            ++jobsForPoints;
        waiting_.push_back({std::move(job), std::move(done)});
    }
    int pump(std::chrono::milliseconds) override {
        auto ready = std::stable_partition(waiting_.begin(), waiting_.end(),
                                           [&](const Job& job) { return holds && !job.job.points.empty(); });
        std::vector<Job> jobs(std::make_move_iterator(ready), std::make_move_iterator(waiting_.end()));
        waiting_.erase(ready, waiting_.end());
        for (Job& job : jobs)
            job.done(decodeNode(job.job));
        return static_cast<int>(jobs.size());
    }
    std::size_t pending() const override { return waiting_.size(); }

  private:
    struct Job {
        DecodeJob job;
        Completion done;
    };
    std::vector<Job> waiting_;
};

} // namespace

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

TEST_CASE("points are decoded where nodes are, those of a node at once, and waited for") {
    auto owned = std::make_unique<HoldingDecoder>();
    HoldingDecoder& decoder = *owned;
    SessionFixture fixture(everything(), std::move(owned));
    fixture.openAndFit(bigCloud());
    REQUIRE(fixture.settle());
    CloudId id = fixture.session->clouds()[0].id;
    std::uint64_t drawn = fixture.pointsDrawn();
    decoder.holds = true;
    NodeKey key = NodeKey{}.child(2);
    for (std::uint32_t index : {7u, 3u, 7u})
        REQUIRE(fixture.session->askPoint({id, key, index}).ok());
    CHECK_FALSE(fixture.settle(20));
    CHECK(decoder.jobsForPoints == 1);
    REQUIRE(fixture.session->askPoint({id, key, 9}).ok()); // after the node was read for the others
    CHECK_FALSE(fixture.settle(20));
    CHECK(decoder.jobsForPoints == 2);
    CHECK(fixture.session->pointsPending());
    CHECK(fixture.session->takePointAnswers().empty());
    CHECK(fixture.pointsDrawn() == drawn);
    decoder.holds = false;
    REQUIRE(fixture.settle());
    std::vector<PointAnswer> answers = fixture.session->takePointAnswers();
    REQUIRE(answers.size() == 4);
    MemorySource source(bigCloud().file);
    auto reader = CloudReader::open(source);
    REQUIRE(reader.ok());
    PointBatch points = *(*reader)->readNode(nodeOf(bigCloud(), key.text()));
    std::size_t n = 0;
    for (std::uint32_t index : {7u, 3u, 7u, 9u}) {
        CHECK(answers[n].point.index == index);
        REQUIRE(answers[n].record.ok());
        CHECK(answers[n++].record->integers == points.positions[index]);
    }
}

TEST_CASE("a decoder's answer about a cloud that is gone, or for a session that is, is let go") {
    auto owned = std::make_unique<HoldingDecoder>();
    HoldingDecoder& decoder = *owned;
    SessionFixture fixture(everything(), std::move(owned));
    fixture.openAndFit(bigCloud());
    REQUIRE(fixture.settle());
    decoder.holds = true;
    CloudId id = fixture.session->clouds()[0].id;
    REQUIRE(fixture.session->askPoint({id, NodeKey{}.child(0), 5}).ok());
    CHECK_FALSE(fixture.settle(20));
    bool goesWhole = GENERATE(false, true);
    if (goesWhole) {
        fixture.session.reset();
    } else {
        fixture.session->removeCloud(id);
        std::vector<PointAnswer> answers = fixture.session->takePointAnswers();
        REQUIRE(answers.size() == 1);
        CHECK(answers[0].record.error().code == ErrorCode::cancelled);
        CHECK_FALSE(fixture.session->pointsPending());
    }
    decoder.holds = false;
    CHECK(decoder.pump({}) == 1);
    if (!goesWhole)
        CHECK(fixture.session->takePointAnswers().empty());
}

TEST_CASE("a point that its node does not have is refused by whoever decodes") {
    const SmallCloud& cloud = smallCloud();
    DecodeJob job;
    job.metadata = std::make_shared<const CloudMetadata>(cloud.metadata);
    job.entry = cloud.nodes[0];
    ByteRange whole = {job.entry.offsetBytes, job.entry.sizeBytes()};
    job.picture.assign(cloud.file.begin() + static_cast<std::ptrdiff_t>(whole.offset),
                       cloud.file.begin() + static_cast<std::ptrdiff_t>(whole.end()));
    job.points = {0};
    REQUIRE(decodeNode(job).ok());
    job.points = {0, job.entry.pointCount};
    auto refused = decodeNode(job);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().code == ErrorCode::invalidArgument);
}

TEST_CASE("the metadata of a cloud that is open can be handed on as its file has it") {
    SessionFixture fixture(everything());
    CHECK(fixture.session->metadataBlock(1).empty());
    fixture.openAndFit(smallCloud());
    CloudId id = fixture.session->clouds()[0].id;
    CHECK(fixture.session->metadataBlock(id).empty()); // not open yet
    REQUIRE(fixture.settle());
    Bytes block = fixture.session->metadataBlock(id);
    auto metadata = parseMetadata(block);
    REQUIRE(metadata.ok());
    CHECK(metadata->pointHash == smallCloud().metadata.pointHash);
    CHECK(block == writeMetadata(*metadata));
}
