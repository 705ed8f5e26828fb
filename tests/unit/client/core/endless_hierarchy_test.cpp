// A terrain of 10^12 points in 10^8 nodes, of which only the chunks that a view needs are ever made: what a
// selection costs follows what is looked at, not what there is.
#include "client/core/camera.hpp"
#include "client/core/hierarchy.hpp"
#include "client/core/selection.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace stipple;

namespace {

constexpr int deepest = 13;       // level of the leaves: 4^13 = 67 million
constexpr int levelsPerChunk = 4; // 84 nodes or 340 a chunk
constexpr std::uint32_t pointsPerNode = 11'200;
constexpr int rootBits = 30;

std::uint64_t nodesInAll() {
    std::uint64_t nodes = 0;
    for (int level = 0; level <= deepest; ++level)
        nodes += std::uint64_t{1} << (2 * level);
    return nodes;
}

std::shared_ptr<const CloudMetadata> metadata() {
    auto made = std::make_shared<CloudMetadata>();
    made->grid.scale = {0.001, 0.001, 0.001};
    made->rootCube = {{0, 0, 0}, rootBits};
    std::int64_t side = std::int64_t{1} << rootBits;
    made->bounds.extend(Vec3i{0, 0, 0});
    made->bounds.extend(Vec3i{side - 1, side - 1, side / 4096});
    made->pointCount = nodesInAll() * pointsPerNode;
    made->spacing = static_cast<double>(side) * 0.001 / 128;
    return made;
}

NodeEntry entryOf(const NodeKey& key, int lastLevel) {
    NodeEntry entry;
    entry.key = key;
    entry.pointCount = pointsPerNode;
    if (key.level < deepest) {
        entry.childMask = 0b1111;
        if (key.level == lastLevel)
            entry.childChunk = {1, 1}; // somewhere else
    }
    return entry;
}

// The nodes below `parent` down to the end of their chunk, breadth first.
std::vector<NodeEntry> chunkBelow(const NodeKey& parent) {
    int last = std::min(parent.level + levelsPerChunk, deepest);
    std::vector<NodeEntry> nodes;
    std::vector<NodeKey> keys{parent};
    for (std::size_t i = 0; i < keys.size(); ++i)
        for (int child = 0; child < 4 && keys[i].level < last; ++child) {
            keys.push_back(keys[i].child(child));
            nodes.push_back(entryOf(keys.back(), last));
        }
    return nodes;
}

struct Endless {
    std::shared_ptr<const CloudMetadata> about = metadata();
    Hierarchy hierarchy = std::move(*Hierarchy::create(about, {entryOf({}, 0)}));
    std::size_t chunks = 0;

    // Selects, and opens the chunks that are asked for, until there are none.
    Selection settle(const Camera& camera, std::uint64_t budget, double detailPixels) {
        for (;;) {
            std::vector<NodeResidency> residency(hierarchy.size());
            for (std::size_t i = 0; i < residency.size(); ++i)
                residency[i].points = pointsPerNode;
            std::vector<SelectionCloud> clouds{{&hierarchy, residency, 12}};
            SelectionInput input;
            input.view = viewTransform(camera, 1920, 1080, about->worldBounds());
            input.height = 1080;
            input.clouds = clouds;
            input.pointBudget = budget;
            input.byteBudget = 1ull << 32;
            input.minNodePixels = 60;
            input.detailPixels = detailPixels;
            Selection selection = select(input);
            if (selection.chunks.empty())
                return selection;
            for (const WantedChunk& chunk : selection.chunks) {
                REQUIRE(hierarchy.add(chunk.node, chunkBelow(hierarchy.node(chunk.node).entry.key)).ok());
                ++chunks;
            }
        }
    }
};

Camera over(double x, double y, double height) {
    Camera camera;
    camera.position = {x, y, height};
    camera.target = {x + 2 * height, y + height, 0};
    return camera;
}

} // namespace

TEST_CASE("a cloud of a million million points is opened as far as it is looked at") {
    CHECK(nodesInAll() * pointsPerNode > 1'000'000'000'000);
    for (double detailPixels : {0.0, 0.5}) {
        Endless cloud;
        double side = 0.001 * static_cast<double>(std::int64_t{1} << rootBits);
        std::size_t known = 0;
        for (double height : {side / 4, side / 30, side / 1000, side / 30'000}) {
            INFO("height " << height << " of " << side << ", detail " << detailPixels);
            Selection selection =
                cloud.settle(over(side * 0.4, side * 0.55, height), 5'000'000, detailPixels);
            CHECK(selection.counters.complete);
            CHECK(selection.nodes.size() >= 10);
            CHECK(selection.counters.pointsDrawn <= 4 * 5'000'000);
            if (detailPixels == 0)
                CHECK(selection.counters.pointsDrawn <= 5'000'000);
            // Deeper views show deeper nodes.
            int finest = 0;
            for (const SelectedNode& node : selection.nodes)
                finest = std::max<int>(finest, cloud.hierarchy.node(node.node).entry.key.level);
            CHECK(finest >= std::min(deepest, static_cast<int>(std::log2(side / height))));
            known = cloud.hierarchy.size();
        }
        CHECK(known < 200'000); // of 89 million
        CHECK(cloud.chunks < 2'000);
    }
}
