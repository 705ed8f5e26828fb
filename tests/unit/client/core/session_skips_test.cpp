#include "client/core/view_session.hpp"

#include "tests/support/session_fixture.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::test;

TEST_CASE("a filter hides points, and a node that is hidden whole is not drawn") {
    SessionFixture fixture(everything());
    fixture.openAndFit(smallCloud());
    Style style;
    style.filters = {{"Point Source ID", 0, 30000}};
    fixture.session->setStyle(style);
    REQUIRE(fixture.settle());
    const FramePlan& plan = fixture.session->plan();
    std::uint64_t points = smallCloud().metadata.pointCount, hidden = 0;
    for (const DrawNode& node : plan.nodes)
        for (std::size_t i = 0; i < node.pointCount; ++i)
            hidden += !node.shows(i);
    CHECK(hidden == plan.counters.pointsHidden);
    CHECK(static_cast<double>(hidden) == Approx(static_cast<double>(points) * 35535 / 65536).epsilon(0.05));
    CHECK(plan.counters.nodesHidden == 0);

    style.filters = {{"Point Source ID", 0.25, 0.75}}; // statistics can't tell, but each node can
    fixture.session->setStyle(style);
    REQUIRE(fixture.settle());
    CHECK(plan.nodes.empty());
    CHECK(plan.counters.nodesHidden == smallCloud().nodes.size());
    CHECK(plan.counters.pointsDrawn == 0);
}

TEST_CASE("a cloud that statistics say is hidden is neither selected nor fetched") {
    SessionFixture fixture(everything());
    Style style;
    style.filters = {{"Point Source ID", 70000, 80000}};
    fixture.session->setStyle(style);
    fixture.openAndFit(bigCloud());
    REQUIRE(fixture.settle());
    CHECK(fixture.session->plan().nodes.empty());
    CHECK(fixture.session->plan().counters.nodesHidden > 0);
    CHECK(fixture.session->counters().nodesDecoded == 0);
    style.filters.clear();
    fixture.session->setStyle(style);
    REQUIRE(fixture.settle());
    CHECK(fixture.pointsDrawn() == bigCloud().metadata.pointCount);
}

TEST_CASE("nodes that are clipped away are neither fetched nor drawn") {
    SessionFixture whole(everything()), fixture(everything());
    whole.openAndFit(bigCloud());
    REQUIRE(whole.settle());
    BoxD bounds = whole.session->contentBounds();
    Style style;
    Vec3d size = bounds.max - bounds.min;
    // The corner at the minimum: one of the root's four children, and the root.
    style.clipBoxes = {{bounds.min, size * 0.25}};
    fixture.session->setStyle(style);
    fixture.openAndFit(bigCloud());
    REQUIRE(fixture.settle());
    const FramePlan& plan = fixture.session->plan();
    CHECK(plan.counters.nodesClipped > 0);
    CHECK(plan.nodes.size() < whole.session->plan().nodes.size());
    CHECK(fixture.session->counters().bytesReceived < whole.session->counters().bytesReceived);
    std::uint64_t shown = 0;
    for (const DrawNode& node : plan.nodes)
        for (std::size_t i = 0; i < node.pointCount; ++i)
            shown += node.shows(i);
    CHECK(shown == plan.counters.pointsDrawn - plan.counters.pointsHidden);
    CHECK(shown > 0);

    std::uint64_t clipped = plan.counters.nodesClipped;
    Style footprint; // the same corner, as a polygon
    Vec3d high = bounds.min + size * 0.25;
    footprint.clipRegions.resize(1);
    footprint.clipRegions[0].shape.rings = {
        {{bounds.min.x, bounds.min.y}, {high.x, bounds.min.y}, {high.x, high.y}, {bounds.min.x, high.y}}};
    footprint.clipRegions[0].shape.heights = ValueRange{bounds.min.z, high.z};
    SessionFixture other(everything());
    other.session->setStyle(footprint);
    other.openAndFit(bigCloud());
    REQUIRE(other.settle());
    const FrameCounters& counters = other.session->plan().counters;
    CHECK(counters.nodesClipped == clipped);
    CHECK(other.session->counters().bytesReceived == fixture.session->counters().bytesReceived);
    CHECK(counters.pointsDrawn - counters.pointsHidden == shown);

    style.clipBoxes[0].halfSize = {1e200, 1, 1}; // can't be computed with
    fixture.session->setStyle(style);
    CHECK(fixture.session->style().clipBoxes[0].halfSize.x < 1e100);
}

TEST_CASE("without a skip more is fetched and drawn, and what shows stays") {
    const SmallCloud& cloud = smallCloud();
    SessionFixture fixture(everything());
    auto script = fixture.open(cloud.file);
    BoxD bounds = cloud.metadata.worldBounds();
    Camera camera; // inside, looking along x: some of the cloud lies behind
    camera.position = (bounds.min + bounds.max) * 0.5;
    camera.target = camera.position + Vec3d{1, 0, 0};
    fixture.session->setCamera(camera);
    auto look = [&](const Style& style, const Skips& skips) {
        SessionLimits limits = everything();
        limits.skips = skips;
        fixture.session->setLimits(limits);
        fixture.session->setStyle(style);
        fixture.session->update();
        REQUIRE(fixture.settle());
        return fixture.session->plan().counters;
    };
    // The shown points of both pictures; the keys of their nodes are in the order of the selection.
    auto shown = [&] {
        std::uint64_t points = 0;
        for (const DrawNode& node : fixture.session->plan().nodes)
            for (std::uint32_t i = 0; i < node.pointCount; ++i)
                points += node.shows(i);
        return points;
    };

    FrameCounters seen = look({}, {}), all = look({}, {.unseen = false});
    CHECK(seen.nodesOutsideFrustum > 0);
    CHECK(all.nodesOutsideFrustum == 0);
    CHECK(all.nodesDrawn == cloud.nodes.size());
    CHECK(seen.nodesDrawn < all.nodesDrawn);

    Style clipped;
    clipped.clipBoxes = {{bounds.min, (bounds.max - bounds.min) * 0.3}};
    Skips skips{.unseen = false};
    FrameCounters cut = look(clipped, skips);
    std::uint64_t left = shown();
    skips.clipped = skips.hidden = false;
    all = look(clipped, skips);
    CHECK(cut.nodesClipped > 0);
    CHECK(all.nodesClipped == 0);
    CHECK(all.nodesDrawn == cloud.nodes.size());
    CHECK(shown() == left);

    Style filtered;
    filtered.filters = {{"Point Source ID", 70000, 80000}}; // beyond all values, as statistics say
    CHECK(look(filtered, {}).nodesDrawn == 0);
    all = look(filtered, {.hidden = false});
    CHECK(all.nodesDrawn == seen.nodesDrawn);
    CHECK(all.pointsHidden == all.pointsDrawn);

    Style continuous;
    continuous.detail.mode = DetailMode::continuous;
    continuous.detail.spacingPixels = 1; // some two of the units that points of the root are apart
    fixture.look(cloud);
    FrameCounters prefixes = look(continuous, {});
    all = look(continuous, {.tooFine = false});
    CHECK(prefixes.pointsTooFine > 0);
    CHECK(all.nodesDrawn == prefixes.nodesDrawn);
    for (const DrawNode& node : fixture.session->plan().nodes)
        CHECK(node.pointCount == node.node->totalPoints);

    std::uint64_t before = fixture.session->counters().attributeBytesFetched;
    look({}, {.unused = false});
    CHECK(fixture.session->counters().attributeBytesFetched > before);
    CHECK(script->reads.size() > 1);
}
