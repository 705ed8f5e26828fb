#include "client/core/continuous_detail.hpp"
#include "client/core/selection.hpp"

#include "client/core/camera.hpp"
#include "client/core/frustum.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>

using namespace stipple;

namespace {

constexpr std::uint32_t rootPoints = 4096, nodePoints = 3072;

// A plane of 64 × 64 m filled down to `levels`: 1 m between the root's points, half of that at each level
// below.
struct Plane {
    Hierarchy hierarchy;
    std::vector<NodeResidency> residency;
    std::vector<SelectionCloud> clouds;
    SelectionInput input;
    Camera camera;

    explicit Plane(int levels, bool lastLevelMissing = false) {
        auto metadata = std::make_shared<CloudMetadata>();
        metadata->grid.scale = {0.001, 0.001, 0.001};
        metadata->rootCube = {{0, 0, 0}, 16};
        metadata->bounds.extend(Vec3i{0, 0, 0});
        metadata->bounds.extend(Vec3i{65535, 65535, 0});
        metadata->pointCount = 1'000'000'000;
        metadata->spacing = 1;
        std::vector<NodeEntry> entries;
        for (int level = 0; level <= levels; ++level)
            for (std::uint32_t y = 0; y < 1u << level; ++y)
                for (std::uint32_t x = 0; x < 1u << level; ++x) {
                    NodeEntry entry;
                    entry.key = {static_cast<std::uint8_t>(level), x, y, 0};
                    entry.pointCount = level == 0 ? rootPoints : nodePoints;
                    entry.childMask = level < levels || lastLevelMissing ? 0b1111 : 0;
                    if (level == levels && lastLevelMissing)
                        entry.childChunk = {1000, 50};
                    entries.push_back(entry);
                }
        std::sort(entries.begin(), entries.end(),
                  [](const NodeEntry& a, const NodeEntry& b) { return a.key < b.key; });
        auto created = Hierarchy::create(metadata, entries);
        if (!created.ok())
            FAIL(created.error().sentence());
        hierarchy = std::move(*created);
        residency.resize(hierarchy.size());
        camera.position = {32, -10, 12};
        camera.target = {32, 30, 0};
        input.height = 600;
        input.pointBudget = 1'000'000'000;
        input.byteBudget = 1ull << 50;
        input.detailPixels = 4;
    }
    void allHere() {
        for (std::size_t i = 0; i < residency.size(); ++i)
            residency[i].points = hierarchy.node(i).entry.pointCount;
    }
    Selection select() {
        input.view = viewTransform(camera, 800, input.height, hierarchy.metadata().worldBounds());
        clouds = {{&hierarchy, residency, 12}};
        input.clouds = clouds;
        return stipple::select(input);
    }
    // What each node shows at the target by definition, without a traversal.
    std::map<std::uint32_t, std::uint32_t> byDefinition(double target) const {
        std::map<std::uint32_t, std::uint32_t> prefixes;
        for (std::uint32_t i = 0; i < hierarchy.size(); ++i) {
            const HierarchyNode& node = hierarchy.node(i);
            RankDensity density = hierarchy.densityOf(i);
            double nearest =
                std::max(Frustum(input.view).nearestDistance(node.geometry.box), input.view.near);
            std::uint32_t prefix = detailPrefix(density, node.entry.pointCount,
                                                target * pixelWorld(input.view, input.height, nearest));
            if (prefix > 0)
                prefixes[i] = prefix;
        }
        return prefixes;
    }
};

} // namespace

TEST_CASE(
    "with room for all, each node in view shows what can show at the target, and nothing else is taken") {
    Plane plane(5);
    plane.allHere();
    for (double target : {16.0, 4.0, 1.5}) {
        plane.input.detailPixels = target;
        Selection frame = plane.select();
        CHECK(frame.counters.detailPixels == target);
        CHECK(frame.counters.complete);
        auto expected = plane.byDefinition(target);
        for (const SelectedNode& node : frame.nodes) {
            CHECK(expected.at(node.node) == node.points);
            CHECK(node.drawPoints == node.points);
        }
        // The rest of them is out of view.
        CHECK(frame.nodes.size() + frame.counters.nodesOutsideFrustum >= expected.size() / 4);
        CHECK(frame.nodes.size() <= expected.size());
        CHECK(frame.counters.pointsTooFine + frame.counters.pointsDrawn <= frame.counters.pointsConsidered);
        CHECK(frame.counters.pointsTooFine > 0);
    }
}

TEST_CASE("a budget raises the target for all nodes alike, by no more than it has to") {
    Plane plane(5);
    plane.allHere();
    plane.input.detailPixels = 0.5;
    std::uint64_t all = plane.select().counters.pointsSelected;
    double last = 0.5;
    for (std::uint64_t budget : {all / 8, all / 32, all / 200}) {
        plane.input.pointBudget = budget;
        Selection frame = plane.select();
        double used =
            std::max(double(frame.counters.pointsExpected), double(frame.counters.pointsSelected) / 4);
        CHECK(used <= double(budget));
        CHECK(used >= 0.97 * double(budget) - 2);
        CHECK(frame.counters.detailPixels > last);
        last = frame.counters.detailPixels;
        auto expected = plane.byDefinition(last);
        for (const SelectedNode& node : frame.nodes)
            CHECK(expected.at(node.node) == node.points);
    }
    plane.input.pointBudget = 1'000'000'000;
    plane.input.byteBudget = 12 * 5000;
    Selection frame = plane.select();
    CHECK(frame.counters.pointsSelected <= 5000);
    CHECK(frame.counters.pointsSelected > 4800);
}

TEST_CASE("the points that are expected to show are about those that do") {
    Plane plane(5);
    plane.allHere();
    for (Vec3d position : {Vec3d{32, -10, 12}, Vec3d{10, 10, 3}, Vec3d{32, 31.9, 60}}) {
        plane.camera.position = position;
        Selection frame = plane.select();
        double shown = 0;
        constexpr int across = 60;
        for (const SelectedNode& selected : frame.nodes) {
            const HierarchyNode& node = plane.hierarchy.node(selected.node);
            RankDensity density = plane.hierarchy.densityOf(selected.node);
            Vec3d low = node.geometry.box.min - plane.input.view.eye,
                  size = node.geometry.box.max - node.geometry.box.min;
            for (int y = 0; y < across; ++y)
                for (int x = 0; x < across; ++x) {
                    Vec3d at = low + Vec3d{size.x * (x + 0.5) / across, size.y * (y + 0.5) / across, 0};
                    const ViewTransform& view = plane.input.view;
                    double depth = dot(at, view.forward), half = depth * view.tanHalfFovY;
                    if (depth < view.near || std::abs(dot(at, view.up)) > half ||
                        std::abs(dot(at, view.right)) > half * view.aspect)
                        continue;
                    shown += detailPrefix(density, node.entry.pointCount, 4 * pixelWorld(view, 600, depth)) /
                             double(across * across);
                }
        }
        CHECK(double(frame.counters.pointsExpected) == Approx(shown).epsilon(0.12));
        CHECK(frame.counters.pointsExpected < frame.counters.pointsSelected);
    }
}

TEST_CASE("where nodes around the eye alone are too much, coarse ones stay and the budget is kept") {
    Plane plane(6);
    plane.allHere();
    plane.camera.position = {33, 33, 0.0};
    plane.camera.target = {60, 60, 0};
    plane.input.pointBudget = 3'000;
    Selection frame = plane.select();
    CHECK(frame.counters.pointsDrawn <= 12'000);
    CHECK(frame.counters.pointsDrawn > 11'900);
    CHECK(frame.counters.nodesOverBudget > 0);
    CHECK(frame.nodes.front().node == 0);
    CHECK(frame.nodes.front().points == rootPoints);
}

TEST_CASE("a budget of nothing selects nothing") {
    Plane plane(2);
    plane.input.pointBudget = 0;
    Selection frame = plane.select();
    CHECK(frame.nodes.empty());
    CHECK(frame.loads.empty());
}

TEST_CASE("only the strata that the prefix needs are wanted, and no child shows before its parent") {
    Plane plane(4);
    Selection frame = plane.select();
    CHECK(frame.counters.pointsDrawn == 0);
    std::size_t whole = 0;
    for (const WantedNode& wanted : frame.loads) {
        auto selected = std::find_if(frame.nodes.begin(), frame.nodes.end(),
                                     [&](const SelectedNode& node) { return node.node == wanted.node; });
        REQUIRE(selected != frame.nodes.end());
        std::uint32_t points = plane.hierarchy.node(wanted.node).entry.pointCount;
        CHECK(wanted.strata <= strataFor(points, selected->points));
        whole += wanted.strata == 4;
    }
    CHECK(whole > 0);
    CHECK(whole < frame.loads.size());
    // All but the root are here: nothing may show.
    plane.allHere();
    plane.residency[0].points = 0;
    CHECK(plane.select().counters.pointsDrawn == 0);
    plane.residency[0].failed = true; // it will never come: the others need not wait
    CHECK(plane.select().counters.pointsDrawn > 0);
}

TEST_CASE("a chunk is asked for where its nodes would show, and only there") {
    Plane plane(3, true);
    plane.allHere();
    plane.input.detailPixels = 0.5;
    Selection frame = plane.select();
    CHECK_FALSE(frame.chunks.empty());
    CHECK_FALSE(frame.counters.complete);
    for (std::size_t i = 1; i < frame.chunks.size(); ++i)
        CHECK(frame.chunks[i - 1].pixels >= frame.chunks[i].pixels);
    plane.input.detailPixels = 200;
    frame = plane.select();
    CHECK(frame.chunks.empty());
    CHECK(frame.counters.complete);
}

TEST_CASE("closer by a little changes a little: no node comes or goes whole") {
    Plane plane(6);
    plane.allHere();
    plane.input.detailPixels = 3;
    Selection before = plane.select();
    std::map<std::uint32_t, std::uint32_t> points;
    for (const SelectedNode& node : before.nodes)
        points[node.node] = node.points;
    plane.camera.position = plane.camera.position + Vec3d{0, 0.05, -0.015}; // 5 cm of 40 m
    std::uint64_t changed = 0;
    for (const SelectedNode& node : plane.select().nodes) {
        std::uint32_t had = points[node.node];
        changed += static_cast<std::uint64_t>(std::abs(std::int64_t{node.points} - std::int64_t{had}));
    }
    CHECK(static_cast<double>(changed) < 0.03 * static_cast<double>(before.counters.pointsSelected));
}
