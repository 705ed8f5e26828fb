// Scenes of hundreds of clouds: those that the view does not show are not even opened.
#include "client/core/frustum.hpp"
#include "tests/support/session_fixture.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <set>

using namespace stipple;
using namespace stipple::test;

namespace {

// Tiles of 100 × 100 units, side by side; each with a source of its own.
struct Tiles {
    static constexpr int columns = 20, rows = 15;
    SessionFixture fixture{everything()};
    struct Tile {
        CloudId id = 0;
        BoxD box;
        std::uint64_t points = 0;
        std::shared_ptr<SourceScript> script = std::make_shared<SourceScript>();
    };
    std::vector<Tile> tiles;

    explicit Tiles(bool saysWhere = true) {
        for (int i = 0; i < columns * rows; ++i) {
            SmallCloudOptions options;
            options.levels = 1;
            options.pointsPerNode = 50;
            options.rootCube.bits = 14; // × 0.01: 163.84 units
            options.grid.scale = {0.01, 0.01, 0.01};
            options.grid.offset = {500000.0 + 200 * (i % columns), 5000000.0 + 200 * (i / columns), 0};
            options.seed = static_cast<std::uint32_t>(i + 1);
            SmallCloud cloud = makeSmallCloud(options);
            Tile& tile = tiles.emplace_back();
            tile.box = cloud.metadata.worldBounds();
            tile.points = cloud.metadata.pointCount;
            tile.script->file = cloud.file;
            tile.id = session().addCloud(std::make_unique<ScriptedSource>(tile.script), "tile",
                                         saysWhere ? tile.box : BoxD());
        }
    }

    ViewSession& session() { return *fixture.session; }
    const FrameCounters& frame() { return session().plan().counters; }
    // From above, so many tiles wide.
    void lookDown(Vec3d middle, double tilesWide) {
        Camera camera;
        camera.projection = Projection::orthographic;
        camera.position = {middle.x, middle.y, 1000};
        camera.target = middle;
        camera.up = {0, 1, 0};
        camera.orthoHeight = 200 * tilesWide * 600 / 800;
        session().setCamera(camera);
    }
    std::vector<const Tile*> inView() {
        Frustum frustum(session().plan().view);
        std::vector<const Tile*> seen;
        for (const Tile& tile : tiles)
            if (frustum.intersects(tile.box))
                seen.push_back(&tile);
        return seen;
    }
    std::size_t asked() const {
        return static_cast<std::size_t>(std::count_if(
            tiles.begin(), tiles.end(), [](const Tile& tile) { return !tile.script->reads.empty(); }));
    }
    CloudStage stageOf(const Tile& tile) {
        for (const CloudState& state : session().clouds())
            if (state.id == tile.id)
                return state.stage;
        FAIL("the cloud is gone");
        return CloudStage::failed;
    }
};

Vec3d middleOf(const Tiles::Tile& tile) {
    return (tile.box.min + tile.box.max) * 0.5;
}

} // namespace

TEST_CASE("of 300 clouds those alone are opened that the view shows, and their points are all drawn") {
    Tiles all;
    all.lookDown(middleOf(all.tiles[43]), 3);
    REQUIRE(all.fixture.settle());
    auto seen = all.inView();
    REQUIRE(seen.size() > 4);
    REQUIRE(seen.size() < 20);
    CHECK(all.asked() == seen.size());
    CHECK(all.frame().cloudsWaiting == all.tiles.size() - seen.size());
    CHECK(all.frame().complete);
    std::uint64_t points = 0;
    for (const Tiles::Tile* tile : seen) {
        CHECK(all.stageOf(*tile) == CloudStage::ready);
        points += tile->points;
    }
    CHECK(all.frame().pointsDrawn == points);
    CHECK(all.stageOf(all.tiles.back()) == CloudStage::waiting);

    // Somewhere else others are opened; back again nothing is asked for.
    all.lookDown(middleOf(all.tiles[250]), 3);
    REQUIRE(all.fixture.settle());
    CHECK(all.asked() == seen.size() + all.inView().size());
    std::uint64_t requests = all.session().counters().requests;
    all.lookDown(middleOf(all.tiles[43]), 3);
    REQUIRE(all.fixture.settle());
    CHECK(all.session().counters().requests == requests);
    CHECK(all.frame().pointsDrawn == points);
}

TEST_CASE("where nobody says where clouds are, all of them are opened") {
    Tiles all(false);
    all.lookDown(middleOf(all.tiles[43]), 3);
    REQUIRE(all.fixture.settle(3000));
    CHECK(all.asked() == all.tiles.size());
    CHECK(all.frame().cloudsWaiting == 0);
}

TEST_CASE("from afar all clouds show, opened from the largest to the smallest") {
    Tiles all;
    SessionLimits limits = everything();
    limits.requestsInFlight = 1;
    all.session().setLimits(limits);
    Camera camera; // along the rows, so that the first tile is the nearest
    camera.position = {500000 - 100, 5000000 - 100, 150};
    camera.target = {504000, 5003000, 0};
    camera.up = {0, 0, 1};
    camera.fovYDegrees = 100;
    all.session().setCamera(camera);
    std::vector<double> sizes; // of clouds in the picture, as they were asked for first
    std::set<CloudId> known;
    for (int i = 0; i < 3000 && !all.session().settled(); ++i) {
        all.session().update();
        for (const Tiles::Tile& tile : all.tiles)
            if (!tile.script->reads.empty() && known.insert(tile.id).second)
                sizes.push_back(length(tile.box.max - tile.box.min) /
                                length(middleOf(tile) - camera.position));
    }
    CHECK(sizes.size() == all.inView().size());
    CHECK(sizes.size() > 200);
    CHECK(std::is_sorted(sizes.rbegin(), sizes.rend()));
}

TEST_CASE("a hidden cloud is not opened before it is shown, or asked for") {
    Tiles all;
    for (const Tiles::Tile& tile : all.tiles)
        all.session().setVisible(tile.id, false);
    all.lookDown(middleOf(all.tiles[43]), 3);
    REQUIRE(all.fixture.settle());
    CHECK(all.asked() == 0);
    all.session().setVisible(all.tiles[43].id, true);
    REQUIRE(all.fixture.settle());
    CHECK(all.asked() == 1);
    all.session().open(all.tiles[299].id);
    REQUIRE(all.fixture.settle());
    CHECK(all.stageOf(all.tiles[299]) == CloudStage::ready);
    CHECK(all.asked() == 2);
    all.session().open(12345); // there is none
    CHECK(all.fixture.settle());
}

TEST_CASE("what clouds are said to fill is content, as long as nobody knows better") {
    SessionFixture fixture(everything());
    auto script = std::make_shared<SourceScript>();
    script->file = smallCloud().file;
    BoxD said;
    said.extend(Vec3d{-1000, -1000, -1000});
    said.extend(Vec3d{1000, 1000, 1000});
    CloudId id = fixture.session->addCloud(std::make_unique<ScriptedSource>(script), "small", said);
    CHECK(fixture.session->contentBounds() == said);
    fixture.look(smallCloud());
    REQUIRE(fixture.settle());
    CHECK(fixture.session->contentBounds() == smallCloud().metadata.worldBounds());
    fixture.session->setVisible(id, false);
    CHECK(fixture.session->contentBounds().empty());
}

TEST_CASE("a box that says nothing does not keep a cloud from being opened") {
    double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (BoxD said :
         {BoxD{{nan, 0, 0}, {1, 1, 1}}, BoxD{{0, 0, 0}, {infinity, 1, 1}}, BoxD{{2, 2, 2}, {1, 1, 1}}}) {
        SessionFixture fixture(everything());
        auto script = std::make_shared<SourceScript>();
        script->file = smallCloud().file;
        fixture.session->addCloud(std::make_unique<ScriptedSource>(script), "small", said);
        fixture.look(smallCloud());
        REQUIRE(fixture.settle());
        CHECK(fixture.pointsDrawn() == smallCloud().metadata.pointCount);
    }
}
