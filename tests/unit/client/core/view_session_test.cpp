#include "client/core/view_session.hpp"

#include "tests/support/session_fixture.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

using namespace stipple;
using namespace stipple::test;

TEST_CASE("a session without clouds is settled after its first update") {
    SessionFixture fixture;
    CHECK(fixture.session->update());
    CHECK_FALSE(fixture.session->update());
    CHECK(fixture.session->settled());
    CHECK(fixture.session->plan().nodes.empty());
    CHECK(fixture.session->contentBounds().empty());
}

TEST_CASE("one request of 64 KiB gives the first picture") {
    SessionFixture fixture(everything());
    auto script = fixture.openAndFit(bigCloud());
    int updates = 0;
    while (fixture.pointsDrawn() == 0 && ++updates < 20) {
        fixture.session->update();
        if (script->reads.size() == 1)
            script->holdAnswers = false;
        else
            script->holdAnswers = true; // whatever is asked for after the first request is not answered
    }
    REQUIRE(fixture.pointsDrawn() > 0);
    CHECK(script->reads[0] == ByteRange{0, 65536});
    CHECK(fixture.session->counters().bytesReceived == 65536);
    const FramePlan& plan = fixture.session->plan();
    REQUIRE(plan.nodes.size() == 1);
    CHECK(plan.nodes[0].node->key == NodeKey{});
    CHECK(plan.nodes[0].pointCount >= 20000 / 8);
    CHECK_FALSE(plan.counters.complete);
    CHECK_FALSE(fixture.session->settled());
}

TEST_CASE("a settled session draws every point, and asked for no byte twice") {
    SessionFixture fixture(everything());
    auto script = fixture.openAndFit(bigCloud());
    REQUIRE(fixture.settle());
    CHECK(fixture.session->recentErrors().empty());
    CHECK(fixture.pointsDrawn() == bigCloud().metadata.pointCount);
    CHECK(fixture.session->plan().nodes.size() == bigCloud().nodes.size());
    CHECK(fixture.session->plan().counters.complete);
    CHECK(bytesAskedTwice(script->reads) == 0);
    std::set<std::uint64_t> ids;
    for (const DrawNode& node : fixture.session->plan().nodes)
        ids.insert(node.node->id);
    CHECK(ids.size() == bigCloud().nodes.size());
    // What was not wanted (other attributes) was hardly fetched.
    CHECK(fixture.session->counters().bytesReceived < bigCloud().file.size());
}

TEST_CASE("a small file is shown without a second request") {
    SmallCloud cloud = makeSmallCloud({.levels = 2, .pointsPerNode = 300});
    REQUIRE(cloud.file.size() < 65536);
    SessionFixture fixture(everything());
    auto script = fixture.openAndFit(cloud);
    REQUIRE(fixture.settle());
    CHECK(script->reads.size() == 1);
    CHECK(fixture.pointsDrawn() == cloud.metadata.pointCount);
}

TEST_CASE("a still camera selects nothing, asks for nothing and draws nothing") {
    SessionFixture fixture(everything());
    fixture.openAndFit(smallCloud());
    REQUIRE(fixture.settle());
    SessionCounters before = fixture.session->counters();
    for (int i = 0; i < 10; ++i)
        CHECK_FALSE(fixture.session->update());
    fixture.session->setCamera(Camera(fixture.session->camera()));
    fixture.session->setStyle(Style(fixture.session->style()));
    CHECK_FALSE(fixture.session->update());
    SessionCounters after = fixture.session->counters();
    CHECK(after.selectionsRun == before.selectionsRun);
    CHECK(after.selectionsSkipped == before.selectionsSkipped + 11);
    CHECK(after.requests == before.requests);
    CHECK(after.framesDrawn == before.framesDrawn);
    CHECK(after.framesSkipped == before.framesSkipped + 11);
}

TEST_CASE("a change of looks draws again, but selects and asks for nothing") {
    SessionFixture fixture(everything());
    fixture.openAndFit(smallCloud());
    REQUIRE(fixture.settle());
    SessionCounters before = fixture.session->counters();
    Style style;
    style.sizePixels = 5;
    fixture.session->setStyle(style);
    CHECK_FALSE(fixture.session->settled());
    CHECK(fixture.session->update());
    CHECK(fixture.session->plan().style.sizePixels == 5);
    CHECK(fixture.session->counters().selectionsRun == before.selectionsRun);
    CHECK(fixture.session->counters().requests == before.requests);
    CHECK(fixture.session->settled());
}

TEST_CASE("limits of requests and bytes on their way hold") {
    SessionLimits limits = everything();
    limits.requestsInFlight = 2;
    limits.bytesInFlight = 500'000;
    limits.mergeGapBytes = 0;
    limits.mergedRequestBytes = 1;
    SessionFixture fixture(limits);
    auto script = fixture.openAndFit(bigCloud());
    REQUIRE(fixture.settle(2000));
    CHECK(script->mostWaiting == 2);
    CHECK(script->mostBytesWaiting <= 500'000);
    CHECK(fixture.session->counters().requestsMerged == 0);
    CHECK(fixture.pointsDrawn() == bigCloud().metadata.pointCount);
}

TEST_CASE("neighbouring ranges travel as one request") {
    // Between pictures lie 900 × 4 bytes of attributes that nobody asked for: within the gap that may be
    // read.
    SmallCloud cloud = makeSmallCloud({.levels = 3, .pointsPerNode = 900});
    SessionLimits limits = everything();
    limits.techniques.adaptive = false; // a second passes with each update, which is a slow network
    SessionFixture fixture(limits);
    fixture.openAndFit(cloud);
    REQUIRE(fixture.settle());
    SessionCounters counters = fixture.session->counters();
    CHECK(counters.requests <= 3);
    CHECK(counters.requestsMerged >= 10);
    CHECK(fixture.pointsDrawn() == cloud.metadata.pointCount);
}

TEST_CASE("a tight budget draws a prefix, and more budget fetches only what is missing") {
    SessionLimits limits = everything();
    limits.pointBudget = 20000 + 6000; // the root, and a prefix of one child
    SessionFixture fixture(limits);
    auto script = fixture.openAndFit(bigCloud());
    REQUIRE(fixture.settle());
    CHECK(fixture.pointsDrawn() == 26000);
    const FramePlan& plan = fixture.session->plan();
    REQUIRE(plan.nodes.size() == 2);
    CHECK(plan.nodes[1].pointCount == 6000);
    CHECK(plan.nodes[1].node->pointCount == 10000); // three strata: half of the node
    CHECK(plan.counters.nodesOverBudget > 0);

    limits.pointBudget = 1'000'000;
    fixture.session->setLimits(limits);
    REQUIRE(fixture.settle());
    CHECK(fixture.pointsDrawn() == bigCloud().metadata.pointCount);
    CHECK(bytesAskedTwice(script->reads) == 0);
}

TEST_CASE("several clouds share one budget") {
    SessionLimits limits = everything();
    limits.pointBudget = 3000;
    SessionFixture fixture(limits);
    fixture.openAndFit(smallCloud());
    fixture.open(smallCloud().file);
    REQUIRE(fixture.settle());
    CHECK(fixture.pointsDrawn() == 3000);
    CHECK(fixture.session->plan().counters.nodesKnown == 2 * smallCloud().nodes.size());
}

TEST_CASE("a hidden cloud is not drawn, and comes back without a request") {
    SessionFixture fixture(everything());
    fixture.openAndFit(smallCloud());
    REQUIRE(fixture.settle());
    CloudId id = fixture.session->clouds()[0].id;
    std::uint64_t requests = fixture.session->counters().requests;
    fixture.session->setVisible(id, false);
    CHECK(fixture.session->update());
    CHECK(fixture.session->plan().nodes.empty());
    CHECK(fixture.session->contentBounds().empty());
    fixture.session->setVisible(id, true);
    CHECK(fixture.session->update());
    CHECK(fixture.pointsDrawn() == smallCloud().metadata.pointCount);
    CHECK(fixture.session->counters().requests == requests);
}

TEST_CASE("the cache stays within its bytes and evicts what was not used lately") {
    SessionLimits limits = everything();
    limits.cacheBytes = 1'000'000; // four nodes of 20,000 points
    SessionFixture fixture(limits);
    fixture.openAndFit(bigCloud());
    REQUIRE(fixture.settle());
    CHECK(fixture.session->plan().counters.nodesOverBudget > 0);
    BoxD bounds = bigCloud().metadata.worldBounds();
    for (Vec3d corner : {bounds.min, Vec3d{bounds.max.x, bounds.max.y, bounds.min.z}}) {
        Camera near;
        near.target = corner;
        near.position = corner + Vec3d{0, 0, 40};
        fixture.session->setCamera(near);
        REQUIRE(fixture.settle());
        CHECK(fixture.session->plan().nodes.size() >= 2);
        CHECK(fixture.session->counters().cacheBytes <= limits.cacheBytes + 50'000);
    }
    CHECK(fixture.session->counters().nodesEvicted > 0);
    CHECK(fixture.session->recentErrors().empty());
}

TEST_CASE("moving on cancels what no longer matters") {
    SessionLimits limits = everything();
    limits.mergedRequestBytes = 1;
    SessionFixture fixture(limits);
    auto script = fixture.openAndFit(bigCloud());
    for (int i = 0; i < 3; ++i)
        fixture.session->update();
    script->holdAnswers = true;
    fixture.session->update();
    REQUIRE(script->waiting > 0);
    Camera away = fixture.session->camera();
    away.target = away.position + Vec3d{0, 0, 100};
    fixture.session->setCamera(away);
    fixture.session->update();
    CHECK(script->cancelled > 0);
    CHECK(script->waiting == 0);
    CHECK(fixture.session->counters().requestsCancelled == static_cast<std::uint64_t>(script->cancelled));
    script->holdAnswers = false;
    REQUIRE(fixture.settle());
    fixture.look(bigCloud());
    REQUIRE(fixture.settle());
    CHECK(fixture.pointsDrawn() == bigCloud().metadata.pointCount);
}

TEST_CASE("removing a cloud cancels its requests and frees all of it") {
    SessionFixture fixture(everything());
    auto script = fixture.openAndFit(bigCloud());
    fixture.open(smallCloud().file);
    while (fixture.pointsDrawn() < 3000)
        fixture.session->update();
    script->holdAnswers = true;
    fixture.session->update();
    CloudId id = fixture.session->clouds()[0].id;
    std::weak_ptr<const ResidentNode> node = fixture.session->plan().nodes.front().node;
    fixture.session->removeCloud(id);
    CHECK(script->destroyed);
    CHECK(script->waiting == 0);
    REQUIRE(fixture.settle());
    CHECK(fixture.session->clouds().size() == 1);
    CHECK(fixture.pointsDrawn() == smallCloud().metadata.pointCount);
    fixture.session->removeCloud(fixture.session->clouds()[0].id);
    CHECK(fixture.session->counters().cacheBytes == 0);
    CHECK(fixture.session->plan().nodes.empty());
    CHECK(fixture.session->update());
    CHECK_FALSE(fixture.session->update());
    CHECK(node.expired());
}

TEST_CASE("a session may end while answers are on their way") {
    auto script = std::make_shared<SourceScript>();
    {
        SessionFixture fixture(everything());
        script = fixture.openAndFit(bigCloud());
        for (int i = 0; i < 3; ++i)
            fixture.session->update();
        script->holdAnswers = true;
        fixture.session->update();
        CHECK(script->waiting > 0);
    }
    CHECK(script->destroyed);
    CHECK(script->waiting == 0);
}

TEST_CASE("the plan names what is awaited, until it is here or will never be") {
    SessionFixture fixture(everything());
    auto script = fixture.openAndFit(bigCloud());
    std::size_t most = 0;
    for (int i = 0; i < 500 && !fixture.session->settled(); ++i) {
        fixture.session->update();
        fixture.now += std::chrono::seconds(1);
        const FramePlan& plan = fixture.session->plan();
        most = std::max(most, plan.awaited.size());
        // What is drawn whole is not awaited, and what is complete awaits nothing.
        for (const DrawNode& node : plan.nodes)
            if (node.pointCount == node.node->totalPoints)
                CHECK(std::none_of(plan.awaited.begin(), plan.awaited.end(),
                                   [&](const AwaitedNode& one) { return one.key == node.node->key; }));
        if (plan.counters.complete)
            CHECK(plan.awaited.empty());
    }
    REQUIRE(fixture.session->settled());
    CHECK(most > 4);
    CHECK(fixture.session->plan().awaited.empty());

    SessionFixture other(everything());
    Style style;
    style.growsWhileLoading = false;
    other.session->setStyle(style);
    other.open(bigCloud().file);
    other.look(bigCloud());
    for (int i = 0; i < 500 && !other.session->settled(); ++i) {
        other.session->update();
        CHECK(other.session->plan().awaited.empty());
    }
    CHECK(other.session->settled());
}
