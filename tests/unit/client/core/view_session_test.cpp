#include "client/core/view_session.hpp"

#include "shared/format/cloud_file.hpp"
#include "shared/io/memory_source.hpp"
#include "tests/support/scripted_source.hpp"
#include "tests/support/small_cloud.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

using namespace stipple;
using namespace stipple::test;

namespace {

std::chrono::steady_clock::time_point fakeNow;
std::chrono::steady_clock::time_point readFakeNow() {
    return fakeNow;
}

struct Fixture {
    std::unique_ptr<NodeDecoder> decoder = makeInlineDecoder();
    std::unique_ptr<ViewSession> session;

    explicit Fixture(const SessionLimits& limits = {}) {
        session = ViewSession::create(*decoder, limits, readFakeNow);
        session->setViewport(800, 600);
    }

    std::shared_ptr<SourceScript> open(Bytes file) {
        auto script = std::make_shared<SourceScript>();
        script->file = std::move(file);
        session->addCloud(std::make_unique<ScriptedSource>(script), "small");
        return script;
    }

    // Updates until settled; false if that takes more than `most` updates. Time goes on by a second each.
    bool settle(int most = 500) {
        for (int i = 0; i < most && !session->settled(); ++i) {
            session->update();
            fakeNow += std::chrono::seconds(1);
        }
        return session->settled();
    }

    // Opens, and looks at everything.
    std::shared_ptr<SourceScript> openAndFit(const SmallCloud& cloud) {
        auto script = open(cloud.file);
        look(cloud);
        return script;
    }
    void look(const SmallCloud& cloud, NamedView view = NamedView::top) {
        session->setCamera(namedCamera(view, cloud.metadata.worldBounds(), 800.0 / 600));
    }

    std::uint64_t pointsDrawn() const { return session->plan().counters.pointsDrawn; }
};

SessionLimits everything() {
    SessionLimits limits;
    limits.minNodePixels = 1;
    return limits;
}

// Bytes that were asked for more than once.
std::uint64_t bytesAskedTwice(const std::vector<ByteRange>& reads) {
    std::vector<ByteRange> sorted = reads;
    std::sort(sorted.begin(), sorted.end(),
              [](const ByteRange& a, const ByteRange& b) { return a.offset < b.offset; });
    std::uint64_t twice = 0, end = 0;
    for (const ByteRange& range : sorted) {
        if (range.offset < end)
            twice += std::min(end, range.end()) - range.offset;
        end = std::max(end, range.end());
    }
    return twice;
}

const NodeEntry& nodeOf(const SmallCloud& cloud, const std::string& key) {
    return *std::find_if(cloud.nodes.begin(), cloud.nodes.end(),
                         [&](const NodeEntry& entry) { return entry.key.text() == key; });
}

// Big enough that most of it lies beyond the first request.
const SmallCloud& bigCloud() {
    static SmallCloud cloud = makeSmallCloud({.levels = 3, .pointsPerNode = 20000});
    return cloud;
}
const SmallCloud& smallCloud() {
    static SmallCloud cloud = makeSmallCloud();
    return cloud;
}

} // namespace

TEST_CASE("a session without clouds is settled after its first update") {
    Fixture fixture;
    CHECK(fixture.session->update());
    CHECK_FALSE(fixture.session->update());
    CHECK(fixture.session->settled());
    CHECK(fixture.session->plan().nodes.empty());
    CHECK(fixture.session->contentBounds().empty());
}

TEST_CASE("one request of 64 KiB gives the first picture") {
    Fixture fixture(everything());
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
    Fixture fixture(everything());
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
    Fixture fixture(everything());
    auto script = fixture.openAndFit(cloud);
    REQUIRE(fixture.settle());
    CHECK(script->reads.size() == 1);
    CHECK(fixture.pointsDrawn() == cloud.metadata.pointCount);
}

TEST_CASE("a still camera selects nothing, asks for nothing and draws nothing") {
    Fixture fixture(everything());
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
    Fixture fixture(everything());
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
    Fixture fixture(limits);
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
    Fixture fixture(limits);
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
    Fixture fixture(limits);
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
    Fixture fixture(limits);
    fixture.openAndFit(smallCloud());
    fixture.open(smallCloud().file);
    REQUIRE(fixture.settle());
    CHECK(fixture.pointsDrawn() == 3000);
    CHECK(fixture.session->plan().counters.nodesKnown == 2 * smallCloud().nodes.size());
}

TEST_CASE("a hidden cloud is not drawn, and comes back without a request") {
    Fixture fixture(everything());
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
    Fixture fixture(everything());
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

TEST_CASE("normals are fetched for discs alone, once, and travel with the nodes of the plan") {
    // So large that no block lies in the gap between two others that travel as one request.
    SmallCloud cloud = makeSmallCloud({.levels = 3, .pointsPerNode = 4000, .withNormals = true});
    Fixture fixture(everything());
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
    Fixture fixture(everything());
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
    Fixture fixture(everything());
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

TEST_CASE("attributes that nothing uses are the first to go when room is short") {
    Fixture fixture(everything());
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
    Fixture fixture(everything());
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
        Fixture fixture(everything());
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
    Fixture fixture(everything());
    fixture.session->setStyle(coloured(ColourMode::intensity));
    fixture.openAndFit(cloud);
    REQUIRE(fixture.settle());
    REQUIRE(fixture.session->plan().nodes.size() == 1);
    std::vector<std::uint32_t> words = fixture.session->plan().nodes[0].colourWords();
    CHECK(words.size() == 400);
    CHECK(std::set<std::uint32_t>(words.begin(), words.end()).size() > 100);
    CHECK(fixture.session->counters().attributeBytesFetched == 0);
}

TEST_CASE("a filter hides points, and a node that is hidden whole is not drawn") {
    Fixture fixture(everything());
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
    Fixture fixture(everything());
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
    Fixture whole(everything()), fixture(everything());
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

    style.clipBoxes[0].halfSize = {1e200, 1, 1}; // can't be computed with
    fixture.session->setStyle(style);
    CHECK(fixture.session->style().clipBoxes[0].halfSize.x < 1e100);
}

TEST_CASE("without a skip more is fetched and drawn, and what shows stays") {
    const SmallCloud& cloud = smallCloud();
    Fixture fixture(everything());
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

TEST_CASE("the level of a leaf's point follows its density, as the choice of points does") {
    SmallCloud cloud = makeSmallCloud({.levels = 2}); // a root and its four leaves, 400 points each
    Fixture fixture(everything());
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

    Fixture fixture(everything());
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
    Fixture fixture(everything());
    Style style;
    style.colourMode = ColourMode::intensity;
    fixture.session->setStyle(style);
    fixture.openAndFit(cloud);
    REQUIRE(fixture.settle());
    CHECK(fixture.pointsDrawn() == cloud.metadata.pointCount);
    const Range& range = fixture.session->plan().style.intensityRange;
    CHECK(range.min < range.max);
}

TEST_CASE("the cache stays within its bytes and evicts what was not used lately") {
    SessionLimits limits = everything();
    limits.cacheBytes = 1'000'000; // four nodes of 20,000 points
    Fixture fixture(limits);
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
    Fixture fixture(limits);
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

TEST_CASE("a failure that passes is tried again, after a pause") {
    Fixture fixture(everything());
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
    Fixture fixture(everything());
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
    Fixture fixture(limits);
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
    Fixture fixture(everything());
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
    Fixture fixture(everything());
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

TEST_CASE("removing a cloud cancels its requests and frees all of it") {
    Fixture fixture(everything());
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
        Fixture fixture(everything());
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

TEST_CASE("every point of a picture can be asked for, exactly and with all attributes") {
    SmallCloud cloud = makeSmallCloud({.levels = 3, .pointsPerNode = 500, .innerColour = InnerColour::mean});
    Fixture fixture(everything());
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
    Fixture fixture(everything());
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
    Fixture fixture(limits);
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

TEST_CASE("what is no cloud fails with one sentence") {
    Bytes file = GENERATE(Bytes{}, Bytes(10, 7), Bytes(100'000, 0), Bytes(64, 255));
    Fixture fixture;
    fixture.open(file);
    REQUIRE(fixture.settle());
    CloudState state = fixture.session->clouds()[0];
    CHECK(state.stage == CloudStage::failed);
    CHECK_FALSE(state.error.sentence().empty());
}

TEST_CASE("every truncation of a file ends in an error, and settles") {
    SmallCloud cloud = makeSmallCloud({.levels = 2, .pointsPerNode = 60});
    for (std::size_t size = 0; size < cloud.file.size(); size += 1 + size / 40) {
        Fixture fixture(everything());
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
        Fixture fixture(everything());
        fixture.open(std::move(damaged));
        fixture.look(cloud);
        REQUIRE(fixture.settle());
        bool whole = fixture.pointsDrawn() == cloud.metadata.pointCount;
        CHECK((whole || !fixture.session->recentErrors().empty()));
    }
}

TEST_CASE("the plan names what is awaited, until it is here or will never be") {
    Fixture fixture(everything());
    auto script = fixture.openAndFit(bigCloud());
    std::size_t most = 0;
    for (int i = 0; i < 500 && !fixture.session->settled(); ++i) {
        fixture.session->update();
        fakeNow += std::chrono::seconds(1);
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

    Fixture other(everything());
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

TEST_CASE("nodes that will never come are not awaited") {
    Fixture fixture(everything());
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
