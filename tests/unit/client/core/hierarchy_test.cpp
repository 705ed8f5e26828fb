// What a hierarchy does with chunks that lie.
#include "client/core/hierarchy.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace stipple;

namespace {

std::shared_ptr<CloudMetadata> metadataOf(int rootBits = 10) {
    auto metadata = std::make_shared<CloudMetadata>();
    metadata->grid.scale = {1, 1, 1};
    metadata->rootCube = {{0, 0, 0}, rootBits};
    metadata->bounds.extend(Vec3i{0, 0, 0});
    metadata->bounds.extend(Vec3i{1023, 1023, 1023});
    metadata->pointCount = 1000;
    metadata->spacing = 8;
    return metadata;
}

NodeEntry entry(NodeKey key, std::uint8_t childMask, ByteRange childChunk = {}, std::uint32_t points = 10) {
    NodeEntry made;
    made.key = key;
    made.childMask = childMask;
    made.pointCount = points;
    made.childChunk = childChunk;
    return made;
}

const NodeKey root{};
const ByteRange elsewhere{500, 20};

Hierarchy rootWithChildrenElsewhere() {
    auto hierarchy = Hierarchy::create(metadataOf(), {entry(root, 0b11, elsewhere)});
    REQUIRE(hierarchy.ok());
    return std::move(*hierarchy);
}

void checkRefused(const std::vector<NodeEntry>& nodes) {
    Hierarchy hierarchy = rootWithChildrenElsewhere();
    Status status = hierarchy.add(0, nodes);
    REQUIRE_FALSE(status.ok());
    CHECK((status.error().code == ErrorCode::corrupt || status.error().code == ErrorCode::limitExceeded));
    // As it was, and still able to take the right chunk.
    CHECK(hierarchy.size() == 1);
    CHECK(hierarchy.node(0).childrenState == ChildrenState::missing);
    CHECK(hierarchy.node(0).children == std::array<std::int32_t, 8>{-1, -1, -1, -1, -1, -1, -1, -1});
    CHECK(hierarchy.add(0, {entry(root.child(0), 0), entry(root.child(1), 0)}).ok());
}

} // namespace

TEST_CASE("a hierarchy grows chunk by chunk") {
    Hierarchy hierarchy = rootWithChildrenElsewhere();
    NodeKey a = root.child(0), b = root.child(1);
    REQUIRE(hierarchy.add(0, {entry(a, 0b100), entry(b, 0b1, elsewhere), entry(a.child(2), 0)}).ok());
    CHECK(hierarchy.size() == 4);
    CHECK(hierarchy.node(0).childrenState == ChildrenState::known);
    CHECK(hierarchy.node(1).children[2] == 3);
    CHECK(hierarchy.node(3).parent == 1);
    CHECK(hierarchy.node(2).childrenState == ChildrenState::missing);
    REQUIRE(hierarchy.add(2, {entry(b.child(0), 0)}).ok());
    CHECK(hierarchy.node(2).children[0] == 4);
    CHECK(hierarchy.spacingOf(a.child(2)) == 2);
    CHECK_FALSE(hierarchy.add(2, {entry(b.child(0), 0)}).ok());
    CHECK(hierarchy.size() == 5);
}

TEST_CASE("a node's box is its cube within the bounds of the points") {
    auto metadata = metadataOf();
    metadata->grid = {{0.5, 0.5, 2}, {100, 200, 300}};
    metadata->bounds = {};
    metadata->bounds.extend(Vec3i{10, 20, 30});
    metadata->bounds.extend(Vec3i{700, 800, 90});
    auto hierarchy = Hierarchy::create(metadata, {entry(root, 0)});
    REQUIRE(hierarchy.ok());
    NodeGeometry geometry = hierarchy->geometryOf(root.child(1));
    CHECK(geometry.box.min == Vec3d{356, 210, 360});
    CHECK(geometry.box.max == Vec3d{450, 456, 480});
    CHECK(geometry.centre == Vec3d{484, 328, 812});
    CHECK(geometry.radius == Approx(std::sqrt(128 * 128 * 2 + 512 * 512)));
}

TEST_CASE("a chunk that lies about its nodes is refused as a whole") {
    NodeKey a = root.child(0), b = root.child(1);
    checkRefused({});                                                          // none
    checkRefused({entry(a, 0)});                                               // one left out
    checkRefused({entry(a, 0), entry(b, 0), entry(root.child(2), 0)});         // not announced
    checkRefused({entry(a, 0), entry(a, 0), entry(b, 0)});                     // twice
    checkRefused({entry(root, 0b11, elsewhere)});                              // the chunk above: a circle
    checkRefused({entry(a, 0b1), entry(b, 0)});                                // a child left out
    checkRefused({entry(a, 0), entry(b, 0), entry(a.child(0), 0)});            // a child not announced
    checkRefused({entry(a, 1, elsewhere), entry(b, 0), entry(a.child(0), 0)}); // announced elsewhere
    checkRefused({entry(NodeKey{1, 7, 0, 0}, 0), entry(b, 0)});                // outside the cube
    checkRefused({entry(NodeKey{9, 0, 0, 0}, 0), entry(b, 0)});                // without a parent
    checkRefused({entry(a, 0, {}, 900), entry(b, 0, {}, 200)});                // more than the cloud has
    checkRefused({entry(a, 0, {}, 4'000'000'000u), entry(b, 0, {}, 4'000'000'000u)}); // far more
}

TEST_CASE("a tree deeper than its grid is refused") {
    auto metadata = metadataOf(1);
    metadata->bounds = {};
    metadata->bounds.extend(Vec3i{1, 1, 1});
    NodeKey a = root.child(0);
    CHECK(Hierarchy::create(metadata, {entry(root, 1), entry(a, 0)}).ok());
    CHECK_FALSE(Hierarchy::create(metadata, {entry(root, 1), entry(a, 1), entry(a.child(0), 0)}).ok());
}

TEST_CASE("a node too wide for its coordinates holds no points") {
    auto metadata = metadataOf(40);
    CHECK_FALSE(Hierarchy::create(metadata, {entry(root, 0)}).ok());
    CHECK(Hierarchy::create(metadata, {entry(root, 0, {}, 0)}).ok());
}

TEST_CASE("a first chunk without the root, or a grid without numbers, is refused") {
    CHECK_FALSE(Hierarchy::create(metadataOf(), {}).ok());
    CHECK_FALSE(Hierarchy::create(metadataOf(), {entry(root.child(1), 0)}).ok());
    CHECK_FALSE(Hierarchy::create(metadataOf(), {entry(root, 0), entry(root, 0)}).ok());
    for (double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
        auto metadata = metadataOf();
        metadata->grid.scale.y = bad;
        CHECK_FALSE(Hierarchy::create(metadata, {entry(root, 0)}).ok());
    }
    auto metadata = metadataOf();
    metadata->grid.offset.x = std::nan("");
    CHECK_FALSE(Hierarchy::create(metadata, {entry(root, 0)}).ok());
    metadata = metadataOf();
    metadata->rootCube.min.z = INT64_MIN;
    CHECK_FALSE(Hierarchy::create(metadata, {entry(root, 0)}).ok());
    metadata = metadataOf(53);
    CHECK_FALSE(Hierarchy::create(metadata, {entry(root, 0, {}, 0)}).ok());
}
