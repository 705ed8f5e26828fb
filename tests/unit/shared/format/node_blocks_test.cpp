#include "shared/codec/progressive_order.hpp"
#include "shared/format/block_frame.hpp"
#include "tests/unit/shared/codec/damage.hpp"
#include "tests/unit/shared/format/sample_cloud.hpp"

#include <algorithm>
#include <numeric>

using namespace stipple;
using namespace stipple::test;

namespace {

PointBatch reordered(const CloudMetadata& metadata, const PointBatch& points, std::uint32_t seed) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(seed));
    PointBatch other;
    other.resize(metadata.schema, points.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        other.positions[i] = points.positions[order[i]];
        for (std::size_t c = 0; c < points.columns.size(); ++c) {
            std::size_t size = metadata.schema.attributes[c].size();
            std::memcpy(other.columns[c].data() + i * size, points.columns[c].data() + order[i] * size, size);
        }
    }
    return other;
}

Bytes strataBytes(const EncodedNode& node, int strata) {
    Bytes bytes;
    for (int s = 0; s < strata; ++s)
        bytes.insert(bytes.end(), node.strata[static_cast<std::size_t>(s)].begin(),
                     node.strata[static_cast<std::size_t>(s)].end());
    return bytes;
}

NodeEntry entryOf(const EncodedNode& node) {
    NodeEntry entry;
    entry.key = node.key;
    entry.pointCount = node.pointCount;
    for (std::size_t s = 0; s < strataCount; ++s)
        entry.strataBytes[s] = static_cast<std::uint32_t>(node.strata[s].size());
    for (const Bytes& block : node.attributes)
        entry.attributeBytes.push_back(static_cast<std::uint32_t>(block.size()));
    return entry;
}

bool sameBytes(const EncodedNode& a, const EncodedNode& b) {
    return a.strata == b.strata && a.attributes == b.attributes;
}

} // namespace

TEST_CASE("the same points in another order give the same bytes") {
    CloudMetadata metadata = sampleMetadata();
    PointBatch points = randomPoints(metadata, {}, 3000, 1);
    for (std::size_t i = 100; i < 300; ++i) // many at one place, told apart by their attributes only
        points.positions[i] = points.positions[0];
    EncodedNode node = need(encodeNode(metadata, {}, points));
    for (std::uint32_t seed : {1u, 2u, 3u})
        CHECK(sameBytes(node, need(encodeNode(metadata, {}, reordered(metadata, points, seed)))));
}

TEST_CASE("each prefix of strata is a prefix of the whole picture") {
    CloudMetadata metadata = sampleMetadata();
    for (std::size_t count : {1u, 2u, 3u, 9u, 2500u}) {
        EncodedNode node = need(encodeNode(metadata, {}, randomPoints(metadata, {}, count, 4)));
        NodeEntry entry = entryOf(node);
        NodePicture whole = need(decodePicture(metadata, entry, strataCount, strataBytes(node, strataCount)));
        REQUIRE(whole.size() == count);
        for (int strata = 1; strata < strataCount; ++strata) {
            NodePicture part = need(decodePicture(metadata, entry, strata, strataBytes(node, strata)));
            REQUIRE(part.size() == strataPrefixPoints(entry.pointCount, strata));
            CHECK(std::equal(part.positions.begin(), part.positions.end(), whole.positions.begin()));
            CHECK(std::equal(part.colour.begin(), part.colour.end(), whole.colour.begin()));
        }
    }
}

TEST_CASE("small attributes that are read together share a block") {
    CloudMetadata metadata = sampleMetadata();
    auto blocks = attributeBlocks(metadata);
    REQUIRE(blocks.size() == 12);
    CHECK(blocks[0].attributes == std::vector<int>{0});    // Intensity
    CHECK(blocks[1].attributes == std::vector<int>{1, 2}); // Return Number, Number of Returns
    CHECK(blocks[2].attributes == std::vector<int>{3});    // User Data
    metadata.pictureColour = PictureColour::intensity;
    CHECK(attributeBlocks(metadata).size() == 14);
}

TEST_CASE("an attribute of zeros takes no bytes") {
    CloudMetadata metadata = sampleMetadata();
    EncodedNode node = need(encodeNode(metadata, {}, randomPoints(metadata, {}, 100, 4)));
    CHECK(node.attributes[2].empty());
    auto columns = need(decodeAttributes(metadata, entryOf(node), 2, {}));
    REQUIRE(columns.size() == 1);
    CHECK(columns[0] == Bytes(100));
}

TEST_CASE("a million equal points are one node, and few bytes justify only few points") {
    CloudMetadata metadata;
    metadata.rootCube.bits = 10;
    PointBatch points;
    points.resize(metadata.schema, 1000000);
    EncodedNode node = need(encodeNode(metadata, {}, points));
    Bytes bytes = strataBytes(node, strataCount);
    CHECK(bytes.size() >= 1000000 / maxPointsPerByte);
    NodeEntry entry = entryOf(node);
    CHECK(need(decodePicture(metadata, entry, strataCount, bytes)).size() == 1000000);

    entry.pointCount = 4000000000u;
    auto refused = decodePicture(metadata, entry, strataCount, bytes);
    REQUIRE(!refused.ok());
    CHECK(refused.error().code == ErrorCode::corrupt);
}

TEST_CASE("points outside the node, other schemas and nodes that are too wide are refused") {
    CloudMetadata metadata = sampleMetadata();
    NodeKey key{2, 1, 2, 3};
    PointBatch points = randomPoints(metadata, key, 10, 1);
    points.positions[3].y += 1 << 18;
    auto outside = encodeNode(metadata, key, points);
    REQUIRE(!outside.ok());
    CHECK(outside.error().code == ErrorCode::outOfRange);
    CHECK(outside.error().sentence().find("2-1-2-3") != std::string::npos);

    points = randomPoints(metadata, key, 10, 1);
    points.columns.pop_back();
    CHECK(encodeNode(metadata, key, points).error().code == ErrorCode::invalidArgument);

    metadata.rootCube.bits = 40;
    CHECK(encodeNode(metadata, {}, randomPoints(metadata, key, 10, 1)).error().code ==
          ErrorCode::invalidArgument);
}

TEST_CASE("a truncated or altered block is an error that names node, block and byte") {
    CloudMetadata metadata = sampleMetadata();
    EncodedNode node = need(encodeNode(metadata, {}, randomPoints(metadata, {}, 200, 9)));
    NodeEntry entry = entryOf(node);
    entry.offsetBytes = 5000;
    Bytes picture = strataBytes(node, strataCount);
    forEachDamage(picture, 2000, [&](const Bytes& damaged) {
        if (damaged == picture)
            return;
        auto read = decodePicture(metadata, entry, strataCount, damaged);
        REQUIRE(!read.ok());
        if (damaged.size() == picture.size())
            CHECK(read.error().sentence().find("node 0-0-0-0, stratum ") == 0);
    });
    for (std::size_t b = 0; b < node.attributes.size(); ++b)
        forEachDamage(node.attributes[b], 300, [&](const Bytes& damaged) {
            CHECK((damaged == node.attributes[b] || !decodeAttributes(metadata, entry, b, damaged).ok()));
        });
}

TEST_CASE("a block whose checksum was made to fit is an error or decodes within the node") {
    CloudMetadata metadata = sampleMetadata();
    EncodedNode node = need(encodeNode(metadata, {}, randomPoints(metadata, {}, 200, 9)));
    NodeEntry entry = entryOf(node);
    Bytes payload(node.strata[0].begin() + blockFrameBytes, node.strata[0].end());
    forEachDamage(payload, 3000, [&](const Bytes& damaged) {
        Bytes block = framePaddedBlock(damaged);
        NodeEntry changed = entry;
        changed.strataBytes[0] = static_cast<std::uint32_t>(block.size());
        auto read = decodePicture(metadata, changed, 1, block);
        CHECK((!read.ok() || read->size() == 25));
    });
}
