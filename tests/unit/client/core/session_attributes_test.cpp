#include "client/core/view_session.hpp"

#include "shared/format/cloud_file.hpp"
#include "shared/io/memory_source.hpp"
#include "tests/support/session_fixture.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

using namespace stipple;
using namespace stipple::test;

namespace {

Style coloured(ColourMode mode) {
    Style style;
    style.colourMode = mode;
    return style;
}

// The painted words of all drawn nodes.
std::map<NodeKey, std::vector<std::uint32_t>> paintedWords(const FramePlan& plan) {
    std::map<NodeKey, std::vector<std::uint32_t>> words;
    for (const DrawNode& node : plan.nodes)
        words[node.node->key] = node.colourWords();
    return words;
}

} // namespace

TEST_CASE("intensity is fetched when the style asks for it, and kept") {
    SessionFixture fixture(everything());
    auto script = fixture.openAndFit(bigCloud());
    REQUIRE(fixture.settle());
    for (const DrawNode& node : fixture.session->plan().nodes)
        CHECK_FALSE(node.paint);
    std::uint64_t offered = 0, intensity = 0;
    for (const NodeEntry& node : bigCloud().nodes) {
        intensity += node.attributeBytes[0];
        for (std::uint32_t bytes : node.attributeBytes)
            offered += bytes;
    }
    CHECK(fixture.session->counters().attributeBytesOffered == offered);
    CHECK(fixture.session->counters().attributeBytesFetched == 0);
    fixture.session->setStyle(coloured(ColourMode::intensity));
    REQUIRE(fixture.settle());
    CHECK(fixture.pointsDrawn() == bigCloud().metadata.pointCount);
    for (const DrawNode& node : fixture.session->plan().nodes) {
        REQUIRE(node.paint);
        CHECK(node.paint->words->size() == node.node->pointCount);
        CHECK(node.node->colourWords.size() == node.node->pointCount);
    }
    const Range& range = fixture.session->plan().style.intensityRange;
    CHECK(range.min == Approx(12768));
    CHECK(range.max == Approx(52768));
    CHECK(bytesAskedTwice(script->reads) == 0);
    CHECK(fixture.session->counters().attributeBytesFetched == intensity);

    std::uint64_t requests = fixture.session->counters().requests;
    fixture.session->setStyle(coloured(ColourMode::rgb));
    REQUIRE(fixture.settle());
    fixture.session->setStyle(coloured(ColourMode::intensity));
    REQUIRE(fixture.settle());
    CHECK(fixture.session->counters().requests == requests);
}

TEST_CASE("attributes that nothing uses are the first to go when room is short") {
    SessionFixture fixture(everything());
    fixture.openAndFit(bigCloud());
    fixture.session->setStyle(coloured(ColourMode::intensity));
    REQUIRE(fixture.settle());
    fixture.session->setStyle(coloured(ColourMode::rgb));
    REQUIRE(fixture.settle());
    CHECK(fixture.session->counters().columnsDropped == 0);
    SessionLimits limits = everything();
    limits.cacheBytes = fixture.session->counters().cacheBytes - 1;
    fixture.session->setLimits(limits);
    REQUIRE(fixture.settle());
    CHECK(fixture.session->counters().columnsDropped == bigCloud().nodes.size());
    CHECK(fixture.session->counters().nodesEvicted == 0);
    CHECK(fixture.pointsDrawn() == bigCloud().metadata.pointCount);
}

TEST_CASE("a node is painted once as long as nothing about it changes") {
    SessionFixture fixture(everything());
    fixture.openAndFit(smallCloud());
    Style style = coloured(ColourMode::elevation);
    fixture.session->setStyle(style);
    REQUIRE(fixture.settle());
    std::uint64_t painted = fixture.session->counters().nodesPainted;
    CHECK(painted >= smallCloud().nodes.size()); // strata of a node come one after the other
    Camera camera = fixture.session->camera();
    camera.position = camera.position + Vec3d{0.5, 0, 0};
    fixture.session->setCamera(camera);
    style.sizePixels = 5;
    fixture.session->setStyle(style);
    REQUIRE(fixture.settle());
    CHECK(fixture.session->counters().nodesPainted == painted);
    style.elevationRange = {0, 1};
    fixture.session->setStyle(style);
    REQUIRE(fixture.settle());
    CHECK(fixture.session->counters().nodesPainted == painted + smallCloud().nodes.size());
}

TEST_CASE("intensity from the start belongs to the right points") {
    SmallCloud cloud = makeSmallCloud({.levels = 2, .pointsPerNode = 5000});
    SmallCloud same = makeSmallCloud({.levels = 2, .pointsPerNode = 5000});
    auto painted = [](const SmallCloud& of, bool fromTheStart) {
        SessionFixture fixture(everything());
        Style style = coloured(ColourMode::intensity);
        style.gradient = GradientName::grey;
        if (fromTheStart)
            fixture.session->setStyle(style);
        fixture.openAndFit(of);
        REQUIRE(fixture.settle());
        fixture.session->setStyle(style);
        REQUIRE(fixture.settle());
        return paintedWords(fixture.session->plan());
    };
    auto first = painted(cloud, true);
    CHECK(first.size() == 5);
    CHECK(first == painted(same, false));
}

TEST_CASE("a cloud whose main colour is intensity needs no further block") {
    SmallCloud cloud = makeSmallCloud({.levels = 1, .colour = PictureColour::intensity});
    SessionFixture fixture(everything());
    fixture.session->setStyle(coloured(ColourMode::intensity));
    fixture.openAndFit(cloud);
    REQUIRE(fixture.settle());
    REQUIRE(fixture.session->plan().nodes.size() == 1);
    std::vector<std::uint32_t> words = fixture.session->plan().nodes[0].colourWords();
    CHECK(words.size() == 400);
    CHECK(std::set<std::uint32_t>(words.begin(), words.end()).size() > 100);
    CHECK(fixture.session->counters().attributeBytesFetched == 0);
}

TEST_CASE("the level of a leaf's point follows its density, as the choice of points does") {
    SmallCloud cloud = makeSmallCloud({.levels = 2}); // a root and its four leaves, 400 points each
    SessionFixture fixture(everything());
    fixture.openAndFit(cloud);
    Style style;
    style.detail.mode = DetailMode::continuous;
    style.detail.spacingPixels = 0.01;
    style.colourMode = ColourMode::level;
    style.gradient = GradientName::grey;
    style.levelRange = {0, 2};
    fixture.session->setStyle(style);
    REQUIRE(fixture.settle());
    std::size_t leaves = 0;
    for (const DrawNode& node : fixture.session->plan().nodes) {
        REQUIRE(node.paint);
        for (std::size_t i = 0; i < node.node->pointCount; i += 57) {
            double rank = static_cast<double>(i);
            // Of the root's points those before it; of a leaf's four times what it adds to the root's share.
            double level = node.node->key.level == 0 ? std::log2((rank + 0.5) / 400) / 2
                                                     : std::log2(1 + 1.5 / 400 + rank * 4 / 400) / 2;
            CHECK(((*node.paint->words)[i] & 255) ==
                  Approx(255 * std::clamp(level / 2, 0.0, 1.0)).margin(1.5));
        }
        leaves += node.node->key.level == 1;
    }
    CHECK(leaves == 4);
}

TEST_CASE("where nothing is coarse exact colours are shown, of coarse nodes the means") {
    SmallCloud cloud = makeSmallCloud({.levels = 3, .innerColour = InnerColour::mean});
    MemorySource source(cloud.file);
    auto reader = CloudReader::open(source);
    REQUIRE(reader.ok());
    int red = cloud.metadata.schema.find(attribute_names::red);
    std::map<NodeKey, std::vector<std::uint8_t>> reds;
    for (const NodeEntry& entry : cloud.nodes) {
        auto points = (*reader)->readNode(entry);
        REQUIRE(points.ok());
        for (std::size_t i = 0; i < points->size(); ++i)
            reds[entry.key].push_back(static_cast<std::uint8_t>(points->value<std::uint16_t>(red, i) >> 8));
    }
    auto showsExact = [&](const DrawNode& node) {
        const std::vector<std::uint8_t>& exact = reds[node.node->key];
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < node.pointCount; ++i)
            wrong += static_cast<std::uint8_t>(node.colourWords()[i]) != exact[i];
        return wrong == 0;
    };

    SessionFixture fixture(everything());
    auto script = fixture.openAndFit(cloud);
    REQUIRE(fixture.settle());
    CHECK(fixture.pointsDrawn() == cloud.metadata.pointCount);
    for (const DrawNode& node : fixture.session->plan().nodes)
        CHECK(showsExact(node));
    CHECK(fixture.session->plan().counters.nodesExact == 5); // the root and its children
    CHECK(bytesAskedTwice(script->reads) == 0);

    // One leaf less: its parent and the root show means again.
    SessionLimits limits = everything();
    limits.pointBudget = cloud.metadata.pointCount - 1;
    fixture.session->setLimits(limits);
    REQUIRE(fixture.settle());
    CHECK(fixture.session->plan().counters.nodesExact == 3 + 1);
    for (const DrawNode& node : fixture.session->plan().nodes)
        if (node.node->key.level == 2)
            CHECK(showsExact(node));

    limits.pointBudget = cloud.nodes[0].pointCount;
    fixture.session->setLimits(limits);
    REQUIRE(fixture.settle());
    REQUIRE(fixture.session->plan().nodes.size() == 1);
    CHECK_FALSE(showsExact(fixture.session->plan().nodes[0]));
}

TEST_CASE("a cloud without intensity is drawn all the same in intensity mode") {
    SmallCloud cloud = makeSmallCloud({.levels = 2, .withIntensity = false});
    SessionFixture fixture(everything());
    Style style;
    style.colourMode = ColourMode::intensity;
    fixture.session->setStyle(style);
    fixture.openAndFit(cloud);
    REQUIRE(fixture.settle());
    CHECK(fixture.pointsDrawn() == cloud.metadata.pointCount);
    const Range& range = fixture.session->plan().style.intensityRange;
    CHECK(range.min < range.max);
}
