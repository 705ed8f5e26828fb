#include "client/core/view_session.hpp"

#include "tests/support/session_fixture.hpp"

#include <catch2/catch.hpp>

#include <set>

using namespace stipple;
using namespace stipple::test;

TEST_CASE("normals are fetched for discs alone, once, and travel with the nodes of the plan") {
    // So large that no block lies in the gap between two others that travel as one request.
    SmallCloud cloud = makeSmallCloud({.levels = 3, .pointsPerNode = 4000, .withNormals = true});
    SessionFixture fixture(everything());
    auto script = fixture.openAndFit(cloud);
    std::uint64_t normalBytes = 0; // blocks: Intensity, Point Source ID, nx, ny, nz
    for (const NodeEntry& node : cloud.nodes)
        normalBytes += node.attributeBytes[2] + node.attributeBytes[3] + node.attributeBytes[4];
    REQUIRE(normalBytes > 0);
    Style style;
    for (PointShape shape : {PointShape::circle, PointShape::square, PointShape::paraboloid}) {
        style.shape = shape;
        fixture.session->setStyle(style);
        REQUIRE(fixture.settle());
        CHECK(fixture.session->counters().attributeBytesFetched == 0);
    }
    style.shape = PointShape::disc;
    fixture.session->setStyle(style);
    REQUIRE(fixture.settle());
    CHECK(fixture.session->counters().attributeBytesFetched == normalBytes);
    CHECK(bytesAskedTwice(script->reads) == 0);
    CHECK(fixture.pointsDrawn() == cloud.metadata.pointCount);
    std::set<std::uint64_t> ids;
    for (const DrawNode& node : fixture.session->plan().nodes) {
        REQUIRE(node.normals);
        CHECK(node.normals->words.size() == node.node->totalPoints);
        CHECK(ids.insert(node.normals->id).second);
    }

    std::uint64_t requests = fixture.session->counters().requests;
    style.shape = PointShape::circle;
    fixture.session->setStyle(style);
    REQUIRE(fixture.settle());
    for (const DrawNode& node : fixture.session->plan().nodes)
        CHECK_FALSE(node.normals);
    style.shape = PointShape::disc;
    fixture.session->setStyle(style);
    REQUIRE(fixture.settle());
    for (const DrawNode& node : fixture.session->plan().nodes)
        CHECK((node.normals && ids.contains(node.normals->id)));
    CHECK(fixture.session->counters().requests == requests);
}

TEST_CASE("normals that nothing draws go when room is short, and come back") {
    SmallCloud cloud = makeSmallCloud({.levels = 4, .withNormals = true});
    SessionFixture fixture(everything());
    fixture.openAndFit(cloud);
    Style style;
    style.shape = PointShape::disc;
    fixture.session->setStyle(style);
    REQUIRE(fixture.settle());
    std::uint64_t withNormals = fixture.session->counters().cacheBytes;
    std::uint64_t perPoint = 3 * 2 + 4; // three columns and a word
    SessionLimits limits = everything();
    limits.cacheBytes = withNormals - cloud.metadata.pointCount * perPoint / 2;
    style.shape = PointShape::circle;
    fixture.session->setStyle(style);
    fixture.session->setLimits(limits);
    REQUIRE(fixture.settle());
    CHECK(fixture.session->counters().cacheBytes <= withNormals - cloud.metadata.pointCount * perPoint);
    CHECK(fixture.session->counters().nodesEvicted == 0);
    CHECK(fixture.pointsDrawn() == cloud.metadata.pointCount);
    fixture.session->setLimits(everything());
    style.shape = PointShape::disc;
    fixture.session->setStyle(style);
    REQUIRE(fixture.settle());
    CHECK(fixture.pointsDrawn() == cloud.metadata.pointCount);
    for (const DrawNode& node : fixture.session->plan().nodes)
        CHECK(node.normals);
}

TEST_CASE("a cloud without normals is drawn as circles, and asked for nothing") {
    SmallCloud cloud = makeSmallCloud({.levels = 2});
    SessionFixture fixture(everything());
    fixture.openAndFit(cloud);
    Style style;
    style.shape = PointShape::disc;
    fixture.session->setStyle(style);
    REQUIRE(fixture.settle());
    CHECK(fixture.pointsDrawn() == cloud.metadata.pointCount);
    CHECK(fixture.session->counters().attributeBytesFetched == 0);
    for (const DrawNode& node : fixture.session->plan().nodes)
        CHECK_FALSE(node.normals);
}
