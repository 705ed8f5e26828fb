#include "shared/codec/progressive_order.hpp"
#include "shared/format/block_frame.hpp"
#include "shared/format/file_parts.hpp"
#include "shared/format/hierarchy_layout.hpp"
#include "tests/unit/shared/codec/damage.hpp"
#include "tests/unit/shared/format/sample_cloud.hpp"

#include <bit>
#include <cmath>
#include <set>

using namespace stipple;
using namespace stipple::test;

namespace {

constexpr std::size_t blockCount = 7; // of an airborne scan beside its picture

// The octree of a rough surface: each node has three to five children.
std::vector<NodeKey> surfaceTree(int levels) {
    std::mt19937 random(21);
    std::vector<NodeKey> keys{{}};
    for (std::size_t i = 0; i < keys.size(); ++i)
        if (keys[i].level < levels)
            for (int c = 0; c < 8; ++c)
                if (c < 3 || (c < 5 && random() % 2))
                    keys.push_back(keys[i].child(c));
    return keys;
}

std::vector<NodeEntry> entriesOf(const std::vector<OctreeNode>& octree, const ChunkPlan& plan,
                                 std::size_t filled) {
    std::mt19937 random(4);
    std::normal_distribution<double> noise(0, 1);
    std::vector<NodeEntry> nodes;
    for (std::size_t i : plan.nodes) {
        NodeEntry& node = nodes.emplace_back();
        node.key = octree[i].key;
        node.childMask = octree[i].childMask;
        if (octree[i].childrenElsewhere)
            node.childChunk.size = 3000 + random() % 1000;
        node.pointCount = static_cast<std::uint32_t>(40000 * std::exp(0.25 * noise(random)));
        // Bits a point as in measured clouds: they vary a few percent from node to node, and the
        // strata of a node vary together.
        double bits = 34 * std::exp(0.05 * noise(random));
        auto bytes = [&](double points, double bitsPerPoint) {
            auto size = static_cast<std::uint32_t>(points * bitsPerPoint / 8);
            return size < 2048 ? size : size / 16 * 16;
        };
        for (std::size_t s = 0; s < strataCount; ++s)
            node.strataBytes[s] = bytes(stratumPoints(node.pointCount, static_cast<int>(s)),
                                        bits * (1.06 - 0.02 * double(s)) * std::exp(0.004 * noise(random)));
        for (std::size_t b = 0; b < blockCount; ++b)
            node.attributeBytes.push_back(
                b >= filled ? 0 : bytes(node.pointCount, 8 * std::exp(0.05 * noise(random))));
    }
    return nodes;
}

CloudMetadata airborneMetadata() {
    CloudMetadata metadata;
    metadata.rootCube.bits = 31;
    for (std::size_t i = 0; i < blockCount; ++i)
        metadata.schema.attributes.push_back(
            attributeOf("attribute " + std::to_string(i), AttributeType::u16));
    return metadata;
}

} // namespace

TEST_CASE("missing ancestors are completed, and nodes lie breadth first with siblings together") {
    auto octree = completeOctree({{3, 5, 2, 7}, {1, 0, 1, 0}, {3, 4, 2, 7}});
    std::vector<std::string> names;
    for (const OctreeNode& node : octree)
        names.push_back(node.key.text() + (node.source < 0 ? " new" : ""));
    CHECK(names == std::vector<std::string>{"0-0-0-0 new", "1-0-1-0", "1-1-0-1 new", "2-2-1-3 new", "3-4-2-7",
                                            "3-5-2-7"});
    CHECK(octree[0].childMask == ((1 << 2) | (1 << 5)));
    CHECK(octree[0].descendants == 5);
    CHECK(octree[0].firstChild == 1);
    CHECK(completeOctree({}).size() == 1);
}

TEST_CASE("each node is in one chunk, and chunks stay small") {
    for (int levels : {0, 3, 6, 8}) {
        auto octree = completeOctree(surfaceTree(levels));
        auto chunks = planChunks(octree);
        std::set<std::size_t> seen;
        for (std::size_t c = 0; c < chunks.size(); ++c) {
            CHECK(chunks[c].nodes.size() <= 4096);
            seen.insert(chunks[c].nodes.begin(), chunks[c].nodes.end());
        }
        CHECK(seen.size() == octree.size());
        std::size_t total = 0;
        for (const ChunkPlan& chunk : chunks)
            total += chunk.nodes.size();
        CHECK(total == octree.size());
    }
}

TEST_CASE("a hierarchy of pictures and two attributes takes under ten bytes a node, each further one 1.3") {
    auto bytesPerNode = [](std::size_t filled) {
        auto octree = completeOctree(surfaceTree(7));
        std::size_t bytes = 0;
        for (const ChunkPlan& plan : planChunks(octree)) {
            HierarchyChunk chunk{plan.parent < 0, {}, 0, entriesOf(octree, plan, filled), 5000, 70000};
            if (!chunk.isRoot) {
                chunk.parent = octree[static_cast<std::size_t>(plan.parent)].key;
                chunk.parentChildMask = octree[static_cast<std::size_t>(plan.parent)].childMask;
            }
            bytes += writeHierarchyChunk(chunk).size();
        }
        return double(bytes) / double(octree.size());
    };
    double two = bytesPerNode(2), four = bytesPerNode(4);
    INFO(two << " and " << four << " bytes a node");
    CHECK(two < 10);
    CHECK(four < two + 2.6);
}

TEST_CASE("a chunk comes back with offsets that follow from the order") {
    CloudMetadata metadata = airborneMetadata();
    auto octree = completeOctree(surfaceTree(8));
    auto chunks = planChunks(octree);
    REQUIRE(chunks.size() > 10);
    const ChunkPlan& plan = chunks[3];
    HierarchyChunk chunk{false,
                         octree[static_cast<std::size_t>(plan.parent)].key,
                         octree[static_cast<std::size_t>(plan.parent)].childMask,
                         entriesOf(octree, plan, 7),
                         5000,
                         70000};
    Bytes block = writeHierarchyChunk(chunk);
    constexpr std::uint64_t fileBytes = std::uint64_t{1} << 40;
    auto nodes = need(parseHierarchyChunk(metadata, fileBytes, block));
    REQUIRE(nodes.size() == chunk.nodes.size());
    std::uint64_t data = 5000, child = 70000;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        CHECK(nodes[i].key == chunk.nodes[i].key);
        CHECK(nodes[i].childMask == chunk.nodes[i].childMask);
        CHECK(nodes[i].pointCount == chunk.nodes[i].pointCount);
        CHECK(nodes[i].strataBytes == chunk.nodes[i].strataBytes);
        CHECK(nodes[i].attributeBytes == chunk.nodes[i].attributeBytes);
        CHECK(nodes[i].offsetBytes == data);
        data += nodes[i].sizeBytes();
        CHECK(nodes[i].childChunk.size == chunk.nodes[i].childChunk.size);
        if (nodes[i].childChunk.size > 0)
            CHECK(nodes[i].childChunk.offset == child);
        child += nodes[i].childChunk.size;
    }

    SECTION("in a smaller file it is refused") {
        CHECK(!parseHierarchyChunk(metadata, data - 1, block).ok());
    }
    SECTION("damaged, it is refused") {
        forEachDamage(block, 500, [&](const Bytes& damaged) {
            CHECK((damaged == block || !parseHierarchyChunk(metadata, fileBytes, damaged).ok()));
        });
    }
    SECTION("damaged under a checksum that fits, its ranges still lie in the file") {
        forEachDamage(Bytes(block.begin() + 8, block.end()), 3000, [&](const Bytes& damaged) {
            auto read = parseHierarchyChunk(metadata, fileBytes, frameBlock(damaged));
            if (read)
                for (const NodeEntry& node : *read)
                    if (node.offsetBytes > fileBytes || node.sizeBytes() > fileBytes - node.offsetBytes ||
                        node.childChunk.end() > fileBytes || node.key.level > maxLevel)
                        FAIL("a range outside the file");
        });
    }
}
