// Scans of regions against every point of the cloud tested one by one; what they read, and how they end.
#include "client/core/region_scan.hpp"

#include "client/core/camera.hpp"
#include "client/core/frame_planner.hpp"
#include "client/core/screen_polygon.hpp"
#include "shared/geometry/oriented_box.hpp"
#include "shared/select/region_json.hpp"
#include "shared/select/region_options.hpp"
#include "tests/support/region_points.hpp"
#include "tests/support/scripted_source.hpp"
#include "tests/support/small_cloud.hpp"

#include <nlohmann/json.hpp>

#include <random>

using namespace stipple;
using namespace stipple::test;

namespace {

std::chrono::steady_clock::time_point now;

struct Fixture {
    std::unique_ptr<NodeDecoder> decoder = makeInlineDecoder();
    std::unique_ptr<ViewSession> session = ViewSession::create(*decoder, {}, [] {
        now += std::chrono::milliseconds(300);
        return now;
    });
    std::shared_ptr<SourceScript> script = std::make_shared<SourceScript>();
    CloudId cloud = 0;

    explicit Fixture(Bytes file) {
        session->setViewport(64, 48);
        script->file = std::move(file);
        cloud = session->addCloud(std::make_unique<ScriptedSource>(script), "small");
        for (int i = 0; i < 200 && !session->settled(); ++i)
            session->update();
        REQUIRE(session->clouds()[0].stage == CloudStage::ready);
    }
};

// Four levels, 85 nodes; the world coordinates are exact in double.
const SmallCloud& town() {
    static SmallCloud cloud = makeSmallCloud({.levels = 4,
                                              .pointsPerNode = 500,
                                              .grid = {{0.25, 0.25, 0.25}, {500000, 4000000, 0}},
                                              .rootCube = {{-300, -200, 0}, 12}});
    return cloud;
}

RegionRequest requestFor(const PointFilter& filter) {
    return {1, filter, allAttributes(town().metadata)};
}

// What each region holds, by arithmetic of the test's own.
void compare(const PointFilter& filter, const std::function<bool(Vec3d)>& holds, std::size_t least = 10) {
    Fixture fixture(town().file);
    MemorySource source(town().file);
    std::vector<PointRow> expected = rowsByTesting(source, holds);
    ScannedRows scanned = rowsByScan(*fixture.session, requestFor(filter));
    CHECK(expected.size() >= least);
    REQUIRE(scanned.rows.size() == expected.size());
    CHECK(scanned.rows == expected);
    CHECK(std::is_sorted(scanned.levels.begin(), scanned.levels.end())); // coarse nodes first
    const RegionProgress& p = scanned.progress;
    CHECK(p.nodesDone == scanned.levels.size());
    CHECK(p.nodesToDo == 0);
    CHECK(p.pointsToDo == 0);
    CHECK(p.hierarchyKnown);
}

double unit(std::mt19937_64& random) {
    return std::uniform_real_distribution<double>(0, 1)(random);
}

// Is p in the polygon? By angles, away from its edges.
bool windsAround(const std::vector<Point2d>& corners, Vec3d p) {
    double turn = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        Point2d a = corners[i], b = corners[(i + 1) % corners.size()];
        double ax = a.x - p.x, ay = a.y - p.y, bx = b.x - p.x, by = b.y - p.y;
        turn += std::atan2(ax * by - ay * bx, ax * bx + ay * by);
    }
    return std::abs(turn) > 3;
}

} // namespace

TEST_CASE("a scan of everything has every point and attribute of the cloud") {
    compare(
        {}, [](Vec3d) { return true; }, 42'500);
}

TEST_CASE("a scan of a turned box has the points in it") {
    std::mt19937_64 random(7);
    for (int i = 0; i < 6; ++i) {
        Vec3d centre{500000 + 900 * unit(random), 4000000 + 900 * unit(random), 10 + 250 * unit(random)};
        Vec3d size{50 + 500 * unit(random), 50 + 500 * unit(random), 100 + 700 * unit(random)};
        double degrees = 360 * unit(random);
        BoxAxes axes = axesTurned(degrees);
        PointFilter filter;
        auto box = orientedBox(centre, size, axes, false);
        REQUIRE(box.ok());
        filter.convex = std::make_shared<const ConvexRegion>(*box);
        compare(filter, [&](Vec3d p) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (std::abs(dot(p - centre, axes[axis])) > size[static_cast<int>(axis)] / 2)
                    return false;
            return true;
        });
    }
}

TEST_CASE("a scan of a footprint with a range of heights has the points in it") {
    std::vector<Point2d> star;
    for (int i = 0; i < 9; ++i) {
        double r = i % 2 ? 130.123 : 430.457, turn = 6.283185307179586 * i / 9;
        star.push_back({500400.1 + r * std::cos(turn), 4000400.1 + r * std::sin(turn)});
    }
    PointFilter filter;
    filter.region = std::make_shared<const PolygonRegion>(std::vector<Polygon>{{Ring(star), {}}});
    compare(
        filter, [&](Vec3d p) { return windsAround(star, p); }, 1000);
    limitHeights(filter, {20, 60.25});
    compare(filter, [&](Vec3d p) { return windsAround(star, p) && p.z >= 20 && p.z <= 60.25; });
}

TEST_CASE("a scan of a corridor has the points along its line") {
    std::vector<Point2d> line{{499980.5, 4000010.25}, {500500.125, 4000490.5}};
    PointFilter filter;
    auto corridor = Corridor::make(line, 61.7);
    REQUIRE(corridor.ok());
    filter.corridor = std::make_shared<const Corridor>(*corridor);
    compare(filter, [&](Vec3d p) {
        double dx = line[1].x - line[0].x, dy = line[1].y - line[0].y, length = std::hypot(dx, dy);
        double station = ((p.x - line[0].x) * dx + (p.y - line[0].y) * dy) / length;
        double offset = ((p.x - line[0].x) * dy - (p.y - line[0].y) * dx) / length;
        return station >= 0 && station <= length && std::abs(offset) <= 61.7 / 2;
    });
}

TEST_CASE("a scan of what a polygon on the screen shows has the points that are drawn inside it") {
    // A concave one, as pixels of an 800 × 600 picture.
    std::vector<Point2d> drawn{{150.3, 120.7}, {620.1, 90.2}, {380.4, 260.9}, {650.7, 500.3}, {200.2, 430.6}};
    for (Projection projection : {Projection::perspective, Projection::orthographic}) {
        Camera camera = namedCamera(NamedView::iso, town().metadata.worldBounds(), 800.0 / 600, projection);
        ViewTransform view = viewTransform(camera, 800, 600, town().metadata.worldBounds());
        ScreenPolygon screen = screenPolygon(view, 800, 600, drawn);
        auto prism = ScreenPrism::make(screen);
        REQUIRE(prism.ok());
        PointFilter filter;
        filter.prism = std::make_shared<const ScreenPrism>(*prism);
        compare(
            filter,
            [&](Vec3d p) {
                Vec3d pixel = projectToPixels(view, 800, 600, p);
                return windsAround(drawn, {pixel.x, pixel.y, 0});
            },
            300);
    }
}

namespace {

// Where the points are that a style leaves of the picture of everything.
std::vector<Vec3i> shownWith(const Style& style) {
    Fixture fixture(town().file);
    ViewSession& session = *fixture.session;
    session.setViewport(800, 600);
    SessionLimits limits;
    limits.minNodePixels = 0.01;
    session.setLimits(limits);
    session.setCamera(namedCamera(NamedView::top, town().metadata.worldBounds(), 800.0 / 600));
    session.setStyle(style);
    for (int i = 0; i < 500 && (i == 0 || !session.settled()); ++i)
        session.update();
    REQUIRE(session.settled());
    std::vector<Vec3i> shown;
    for (const DrawNode& node : session.plan().nodes) {
        Vec3i corner = town().metadata.rootCube.nodeMin(node.node->key);
        for (std::uint32_t i = 0; i < node.pointCount; ++i) {
            Vec3<std::uint32_t> p = positionOf(*node.node, i);
            if (node.shows(i))
                shown.push_back({corner.x + p.x, corner.y + p.y, corner.z + p.z});
        }
    }
    std::sort(shown.begin(), shown.end(), [](const Vec3i& a, const Vec3i& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    });
    return shown;
}

// The corners lie on points' places, so edges go through points.
std::vector<RegionShape> clippedShapes() {
    std::vector<RegionShape> shapes(5);
    shapes[0].rings = {
        {{500100, 4000100}, {500800, 4000150}, {500450.25, 4000400.5}, {500700, 4000900}, {500000, 4000700}},
        {{500200, 4000200}, {500400, 4000200}, {500300, 4000500}}};
    shapes[0].heights = ValueRange{20, 160.25};
    shapes[1].rings = {
        {{500000, 4000000}, {500800, 4000800}, {500800, 4000000}, {500000, 4000800}}}; // a bow tie
    shapes[2].line = {{500000, 4000000}, {500500, 4000250}, {500400, 4000900}, {500450, 4000100}};
    shapes[2].width = 80.5;
    shapes[3].prism = ScreenPolygon{
        Vec3d{500400, 4000300, 900},
        {0.1, 0.05, -1},
        {{500200, 4000200, 0}, {500700, 4000250, 0}, {500450, 4000400, 0}, {500600, 4000800, 0}}};
    shapes[4].box =
        RegionShape::Box{{500400, 4000400, 100}, {300, 120, 80}, *axesOfQuaternion(0.3, -0.2, 0.4, 0.8)};
    return shapes;
}

} // namespace

TEST_CASE("what a clip region leaves in the picture is what a scan of the region has") {
    for (const RegionShape& shape : clippedShapes()) {
        INFO(toJson(shape).dump());
        auto filter = filterOf(shape);
        REQUIRE(filter.ok());
        Fixture fixture(town().file);
        ScannedRows scanned = rowsByScan(*fixture.session, requestFor(*filter));
        Style style;
        style.clipRegions = {{shape, ClipMode::hideOutside}};
        std::vector<Vec3i> shown = shownWith(style), expected;
        for (const PointRow& row : scanned.rows)
            expected.push_back({row.first[0], row.first[1], row.first[2]});
        CHECK(expected.size() > 500);
        CHECK(shown == expected);
        style.clipRegions[0].mode = ClipMode::hideInside;
        CHECK(shownWith(style).size() == town().metadata.pointCount - expected.size());
    }
}

TEST_CASE("nodes outside a region are counted and not read, nor are attributes that nobody asked for") {
    Fixture fixture(town().file);
    PointFilter filter;
    filter.box = BoxD{{499900, 3999900, -10}, {500060, 4000080, 40}};
    RegionRequest request = requestFor(filter);
    request.attributes.clear();
    fixture.script->reads.clear();
    ScannedRows scanned = rowsByScan(*fixture.session, request);
    CHECK(scanned.progress.nodesOutside > 0);
    std::uint64_t picture = 0, whole = 0;
    for (const NodeEntry& entry : town().nodes) {
        picture += entry.strataRange(strataCount).size;
        whole += entry.sizeBytes();
    }
    CHECK(scanned.progress.bytesRead < picture / 2);
    CHECK(picture < whole);
    for (const PointRow& row : scanned.rows)
        CHECK(row.second.empty());
    // A box that holds a whole node needs no test of its points.
    filter.box = BoxD{{490000, 3990000, -1e6}, {510000, 4010000, 1e6}};
    CHECK(rowsByScan(*fixture.session, requestFor(filter)).progress.nodesWhole == town().nodes.size());
}

TEST_CASE("what a scan reads ahead is bounded, and one that nobody takes from stands still") {
    SmallCloud large = makeSmallCloud({.levels = 3, .pointsPerNode = 20'000});
    Fixture fixture(large.file);
    fixture.script->holdAnswers = false;
    RegionRequest request{1, {}, allAttributes(large.metadata)};
    request.bytesAhead = 300'000;
    auto scan = fixture.session->scanRegion(request);
    REQUIRE(scan.ok());
    fixture.script->reads.clear();
    for (int i = 0; i < 50; ++i)
        fixture.session->update();
    std::uint64_t read = 0;
    for (const ByteRange& range : fixture.script->reads)
        read += range.size;
    CHECK(read > 0);
    CHECK(read <= 300'000 + (256 << 10)); // and a gap that came along
    CHECK(fixture.session->regionProgress(*scan).nodesDone == 0);
    fixture.session->endRegionScan(*scan);
    CHECK(rowsByScan(*fixture.session, request, 1).progress.pointsDone == large.metadata.pointCount);
}

TEST_CASE("what is on its way for a scan is cancelled when it is ended") {
    SmallCloud large = makeSmallCloud({.levels = 3, .pointsPerNode = 20'000});
    Fixture fixture(large.file);
    auto scan = fixture.session->scanRegion({1, {}, allAttributes(large.metadata)});
    fixture.script->holdAnswers = true;
    fixture.session->update();
    fixture.session->update();
    REQUIRE(fixture.script->waiting > 0);
    int before = fixture.script->cancelled;
    fixture.session->endRegionScan(*scan);
    fixture.session->update();
    CHECK(fixture.script->cancelled > before);
    CHECK(fixture.script->waiting == 0);
    CHECK(fixture.session->regionProgress(*scan).error->code == ErrorCode::cancelled);
    fixture.script->holdAnswers = false;
    for (int i = 0; i < 20; ++i)
        fixture.session->update();
    CHECK(fixture.session->settled());
}

TEST_CASE("a scan goes on after failures that pass, and ends with the error of those that do not") {
    SmallCloud large = makeSmallCloud({.levels = 3, .pointsPerNode = 20'000});
    {
        Fixture fixture(large.file);
        int reads = 0;
        fixture.script->failure = [&](ByteRange) -> std::optional<Error> {
            if (++reads % 3 == 0)
                return Error{ErrorCode::ioFailed, "the disk stutters", "", ""};
            return std::nullopt;
        };
        RegionRequest request{1, {}, allAttributes(large.metadata)};
        request.bytesAhead = 1 << 20;
        CHECK(rowsByScan(*fixture.session, request).rows.size() == large.metadata.pointCount);
        CHECK(reads > 6);
    }
    Fixture fixture(large.file);
    fixture.script->failure = [](ByteRange) {
        return Error{ErrorCode::ioFailed, "the disk is gone", "", ""};
    };
    auto scan = fixture.session->scanRegion({1, {}, {}});
    for (int i = 0; i < 500 && !fixture.session->regionProgress(*scan).error; ++i)
        fixture.session->update();
    RegionProgress progress = fixture.session->regionProgress(*scan);
    REQUIRE(progress.error);
    CHECK(progress.error->what == "the disk is gone");
    CHECK(progress.error->where.find("node ") != std::string::npos);
    CHECK_FALSE(progress.complete);
    CHECK(fixture.session->takeRegionNodes(*scan, 100).empty());
}

TEST_CASE("a scan of a cloud that is closed, or was never there, says so") {
    Fixture fixture(town().file);
    CHECK_FALSE(fixture.session->scanRegion({99, {}, {}}).ok());
    CHECK_FALSE(fixture.session->scanRegion({1, {}, {17}}).ok());
    auto scan = fixture.session->scanRegion(requestFor({}));
    fixture.session->removeCloud(1);
    fixture.session->update();
    CHECK(fixture.session->regionProgress(*scan).error->code == ErrorCode::cancelled);
}

TEST_CASE("the picture's own bytes come before a region's") {
    SmallCloud large = makeSmallCloud({.levels = 3, .pointsPerNode = 20'000});
    // What is here already costs a scan no request, so it may have that: what counts is what is asked for.
    auto look = [&](Fixture& fixture) {
        SessionLimits limits = fixture.session->limits();
        limits.requestsInFlight = 1;
        limits.mergeGapBytes = 0;
        limits.minNodePixels = 1;
        limits.techniques.adaptive = false;
        fixture.session->setLimits(limits);
        fixture.session->setViewport(800, 600);
        fixture.session->setCamera(namedCamera(NamedView::top, large.metadata.worldBounds(), 800.0 / 600));
        fixture.session->update();
    };
    Fixture alone(large.file), scanned(large.file);
    auto scan = scanned.session->scanRegion({1, {}, {}});
    REQUIRE(scan.ok());
    look(alone);
    look(scanned);
    int updates = 0;
    for (; updates < 200 && !alone.session->plan().counters.complete; ++updates) {
        alone.session->update();
        scanned.session->update();
        if (!alone.session->plan().counters.complete)
            CHECK(scanned.script->reads == alone.script->reads);
    }
    CHECK(updates > 10);
    CHECK(scanned.session->plan().counters.complete);
}

TEST_CASE("regions are read from JSON, and what is wrong with them is named") {
    auto read = [](const char* text) { return regionFromJson(nlohmann::json::parse(text), "region"); };
    auto box = read(R"({"box": {"centre": [1, 2, 3], "halfSize": [1, 1, 1]}})");
    REQUIRE(box.ok());
    CHECK(box->convex->contains({2, 3, 4}));
    CHECK_FALSE(box->convex->contains({2.01, 3, 4}));
    auto foot = read(R"({"polygon": [[0, 0], [4, 0], [0, 4]], "heights": [1, 2]})");
    REQUIRE(foot.ok());
    CHECK(foot->region->contains({1, 1}));
    CHECK(foot->box->max.z == 2);
    REQUIRE(read(R"({"line": [[0, 0], [4, 0]], "width": 2})").ok());
    REQUIRE(
        read(
            R"({"prism": {"eye": null, "forward": [0, 0, -1], "corners": [[0, 0, 9], [4, 0, 9], [0, 4, 9]]}})")
            .ok());
    REQUIRE(read("{}").ok());
    auto ring = read(
        R"({"polygon": [[0, 0], [9, 0], [0, 9]], "holes": [[[1, 1], [2, 1], [1, 2]]], "heights": [null, 4]})");
    REQUIRE(ring.ok());
    CHECK_FALSE(ring->region->contains({1.25, 1.25}));
    CHECK(ring->region->contains({1, 1.5}));
    CHECK(std::isinf(ring->box->min.z));
    CHECK(ring->box->max.z == 4);
    for (const RegionShape& shape : clippedShapes()) {
        auto again = shapeFromJson(nlohmann::json::parse(toJson(shape).dump()), "region");
        REQUIRE(again.ok());
        CHECK(*again == shape);
    }
    for (
        const char* text :
        {R"([])", R"({"sphere": 1})", R"({"box": {"centre": [1, 2], "halfSize": [1, 1, 1]}})",
         R"({"box": {"centre": [1, 2, 3]}})",
         R"({"box": {"centre": [1, 2, 3], "halfSize": [1, 1, 1], "axes": [[1, 0, 0]]}})",
         R"({"polygon": [[0, 0], [4, 0]]})", R"({"polygon": [[0, 0], [4, 0], [0]]})",
         R"({"polygon": [[0, 0], [4, 0], [0, 4]], "heights": [2, 1]})", R"({"line": [[0, 0], [4, 0]]})",
         R"({"polygon": []})", R"({"line": [], "width": 2})", R"({"holes": [[[1, 1], [2, 1], [1, 2]]]})",
         R"({"polygon": [[0, 0], [4, 0], [0, 4]], "holes": [[[1, 1], [2, 1]]]})",
         R"({"polygon": [[0, 0], [4, 0], [0, 4]], "holes": [7]})", R"({"heights": ["low", 1]})",
         R"({"prism": {"forward": [0, 0, -1], "corners": [[0, 0, 9], [4, 4, 9], [4, 0, 9], [0, 4, 9]]}})",
         R"({"prism": {"eye": [0, 0, 10], "forward": [0, 0, -1], "corners": [[0, 0, 11], [4, 0, 9], [0, 4, 9]]}})"}) {
        auto region = read(text);
        INFO(text);
        REQUIRE_FALSE(region.ok());
        CHECK(region.error().code == ErrorCode::invalidArgument);
        CHECK(region.error().where.find("region") == 0);
    }
}

TEST_CASE("a region's text is added to what a filter says, and what can't be both is named") {
    const std::string prism =
        R"("prism": {"eye": null, "forward": [0, 0, -1], "corners": [[0, 0, 9], [4, 0, 9], [0, 4, 9]]})";
    const std::string line = R"("line": [[0, 0], [4, 0]], "width": 2)";
    PointFilter filter;
    filter.box = BoxD{{-9, -9, -9}, {9, 9, 3}};
    REQUIRE(addRegion(filter, "{" + prism + R"(, "heights": [1, null]})").ok());
    REQUIRE(filter.prism);
    CHECK(filter.prism->contains({1, 1, 100}));
    CHECK_FALSE(filter.prism->contains({3, 3, 0}));
    CHECK(filter.box->min.z == 1);
    CHECK(filter.box->max.z == 3);
    REQUIRE(addRegion(filter, "{" + line + "}").ok());
    REQUIRE(filter.corridor);

    auto errorOf = [&](const std::string& text) {
        PointFilter to = filter;
        Status added = addRegion(to, text);
        return added.ok() ? "" : added.error().sentence();
    };
    CHECK(errorOf("{" + prism + "}") == "there is another prism (give one of the two)");
    CHECK(errorOf("{" + line + "}") == "there is another line (give one of the two)");
    CHECK(errorOf(R"({"heights": [4, 5]})") == "no height is left");
    CHECK(errorOf("polygon") == "it is no JSON");
    CHECK(errorOf(R"({"sphere": 1})").find("there is no field 'sphere'") == 0);
    CHECK(errorOf(R"({"polygon": [[0, 0], [1]]})") == "polygon[1]: must be 2 numbers");
}
