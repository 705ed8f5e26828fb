#include "client/core/view_session.hpp"

#include "tests/support/session_fixture.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace stipple;
using namespace stipple::test;

TEST_CASE("a failure that passes is tried again, after a pause") {
    SessionFixture fixture(everything());
    auto script = fixture.openAndFit(bigCloud());
    int failures = 0;
    script->failure = [&](ByteRange) -> std::optional<Error> {
        if (++failures > 2)
            return std::nullopt;
        return Error{ErrorCode::networkFailed, "no route", "", ""};
    };
    for (int i = 0; i < 5; ++i)
        fixture.session->update();
    CHECK(script->reads.size() == 1); // no time went by
    CHECK_FALSE(fixture.session->settled());
    REQUIRE(fixture.settle());
    CHECK(fixture.session->recentErrors().empty());
    CHECK(fixture.session->counters().requestsFailed == 2);
    CHECK(fixture.pointsDrawn() == bigCloud().metadata.pointCount);
}

TEST_CASE("a network that stays down ends in a failed cloud, not in a wait") {
    SessionFixture fixture(everything());
    auto script = fixture.openAndFit(smallCloud());
    script->failure = [](ByteRange) { return Error{ErrorCode::networkFailed, "no route", "", ""}; };
    REQUIRE(fixture.settle());
    CHECK(script->reads.size() == 4);
    CloudState state = fixture.session->clouds()[0];
    CHECK(state.stage == CloudStage::failed);
    CHECK(state.error.code == ErrorCode::networkFailed);
    CHECK(state.error.sentence().find("scripted.stipple") != std::string::npos);
    REQUIRE(fixture.session->recentErrors().size() == 1);
}

TEST_CASE("nodes that can't be had are recorded; the others are drawn") {
    SessionLimits limits = everything();
    limits.mergedRequestBytes = 1;
    limits.mergeGapBytes = 0;
    SessionFixture fixture(limits);
    auto script = fixture.openAndFit(bigCloud());
    std::uint64_t lost = nodeOf(bigCloud(), "1-1-1-0").strataRange(4).end() - 1;
    script->failure = [&](ByteRange range) -> std::optional<Error> {
        if (range.offset <= lost && lost < range.end())
            return Error{ErrorCode::ioFailed, "bad sector", "", ""};
        return std::nullopt;
    };
    REQUIRE(fixture.settle(2000));
    REQUIRE(fixture.session->recentErrors().size() == 1);
    CHECK(fixture.session->recentErrors()[0].sentence().find("1-1-1-0") != std::string::npos);
    CHECK(fixture.session->clouds()[0].stage == CloudStage::ready);
    // Its first stratum may have come; all the others are whole, its children too.
    CHECK(fixture.pointsDrawn() >= bigCloud().metadata.pointCount - 20000);
    CHECK(fixture.pointsDrawn() < bigCloud().metadata.pointCount);
}

TEST_CASE("a node that does not decode is asked for once more, then recorded; the others are drawn") {
    SessionFixture fixture(everything());
    SmallCloud damaged = bigCloud();
    ByteRange picture = nodeOf(damaged, "2-3-3-0").strataRange(4);
    for (std::uint64_t i = picture.offset; i < picture.end(); i += 7)
        damaged.file[static_cast<std::size_t>(i)] ^= 0x55;
    auto script = fixture.openAndFit(damaged);
    REQUIRE(fixture.settle());
    REQUIRE(fixture.session->recentErrors().size() == 1);
    CHECK(fixture.session->recentErrors()[0].sentence().find("2-3-3-0") != std::string::npos);
    CHECK(fixture.pointsDrawn() == damaged.metadata.pointCount - 20000);
    CHECK(bytesAskedTwice(script->reads) >= nodeOf(damaged, "2-3-3-0").strataRange(1).size);
}

TEST_CASE("a file that changes fails its cloud and frees it") {
    SessionFixture fixture(everything());
    auto script = fixture.openAndFit(bigCloud());
    for (int i = 0; i < 3; ++i)
        fixture.session->update();
    REQUIRE(fixture.session->clouds()[0].stage == CloudStage::ready);
    script->failure = [](ByteRange) {
        return Error{ErrorCode::changed, "the file is another one now", "", "open it again"};
    };
    REQUIRE(fixture.settle());
    CloudState state = fixture.session->clouds()[0];
    CHECK(state.stage == CloudStage::failed);
    CHECK(state.error.code == ErrorCode::changed);
    CHECK(fixture.session->plan().nodes.empty());
    CHECK(fixture.session->counters().cacheBytes == 0);
    CHECK(script->waiting == 0);
}

TEST_CASE("what is no cloud fails with one sentence") {
    Bytes file = GENERATE(Bytes{}, Bytes(10, 7), Bytes(100'000, 0), Bytes(64, 255));
    SessionFixture fixture;
    fixture.open(file);
    REQUIRE(fixture.settle());
    CloudState state = fixture.session->clouds()[0];
    CHECK(state.stage == CloudStage::failed);
    CHECK_FALSE(state.error.sentence().empty());
}

TEST_CASE("every truncation of a file ends in an error, and settles") {
    SmallCloud cloud = makeSmallCloud({.levels = 2, .pointsPerNode = 60});
    for (std::size_t size = 0; size < cloud.file.size(); size += 1 + size / 40) {
        SessionFixture fixture(everything());
        fixture.open(Bytes(cloud.file.begin(), cloud.file.begin() + static_cast<std::ptrdiff_t>(size)));
        fixture.look(cloud);
        REQUIRE(fixture.settle());
        CHECK(fixture.session->clouds()[0].stage == CloudStage::failed);
        CHECK_FALSE(fixture.session->recentErrors().empty());
    }
}

TEST_CASE("whatever bytes are damaged, the session settles with right points or an error") {
    SmallCloud cloud = makeSmallCloud({.levels = 3, .pointsPerNode = 100});
    std::mt19937 random(7);
    for (int round = 0; round < 200; ++round) {
        Bytes damaged = cloud.file;
        for (int i = 0; i < 1 + round % 5; ++i)
            damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1 + random() % 255);
        SessionFixture fixture(everything());
        fixture.open(std::move(damaged));
        fixture.look(cloud);
        REQUIRE(fixture.settle());
        bool whole = fixture.pointsDrawn() == cloud.metadata.pointCount;
        CHECK((whole || !fixture.session->recentErrors().empty()));
    }
}

TEST_CASE("nodes that will never come are not awaited") {
    SessionFixture fixture(everything());
    auto script = std::make_shared<SourceScript>();
    script->file = bigCloud().file;
    const NodeEntry& lost = nodeOf(bigCloud(), NodeKey{}.child(1).text());
    script->file[static_cast<std::size_t>(lost.offsetBytes + 9)] ^= 0x5A;
    script->file[static_cast<std::size_t>(lost.offsetBytes + 40)] ^= 0x5A;
    fixture.session->addCloud(std::make_unique<ScriptedSource>(script), "damaged");
    fixture.look(bigCloud());
    REQUIRE(fixture.settle());
    CHECK_FALSE(fixture.session->recentErrors().empty());
    CHECK(fixture.session->plan().awaited.empty());
}
