#include "client/core/clips.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>

using namespace stipple;

namespace {

Clips made(std::vector<ClipBox> boxes, std::vector<ClipRegion> regions = {}) {
    auto clips = Clips::make(boxes, regions);
    REQUIRE(clips.ok());
    return std::move(*clips);
}

BoxD boxAround(Vec3d centre, double half) {
    BoxD box;
    box.extend(centre - Vec3d{half, half, half});
    box.extend(centre + Vec3d{half, half, half});
    return box;
}

ClipBox unit(ClipMode mode, Vec3d centre = {0, 0, 0}) {
    ClipBox box{centre, {1, 1, 1}};
    box.mode = mode;
    return box;
}

} // namespace

TEST_CASE("without boxes nothing is hidden") {
    Clips none;
    CHECK(none.empty());
    ClipVerdict verdict = none.clipVerdict(boxAround({0, 0, 0}, 1));
    CHECK_FALSE((verdict.hidden || verdict.tested || verdict.highlighted));
    CHECK_FALSE(none.hides({0, 0, 0}));
}

TEST_CASE("a node is hidden, tested or left alone by where it lies") {
    struct Case {
        Vec3d centre;
        bool inside, across;
    };
    for (auto [centre, inside, across] : {Case{{0, 0, 0}, true, false},
                                          {{0.5, 0.5, 0.5}, true, false}, // touches from inside: closed
                                          {{0.6, 0, 0}, false, true},
                                          {{1.4, 0, 0}, false, true},
                                          {{1.6, 0, 0}, false, false}}) {
        BoxD node = boxAround(centre, 0.5);
        ClipVerdict outside = made({unit(ClipMode::hideOutside)}).clipVerdict(node);
        CHECK(outside.hidden == (!inside && !across));
        CHECK(outside.tested == across);
        ClipVerdict hole = made({unit(ClipMode::hideInside)}).clipVerdict(node);
        CHECK(hole.hidden == inside);
        CHECK(hole.tested == across);
        ClipVerdict tint = made({unit(ClipMode::highlight)}).clipVerdict(node);
        CHECK_FALSE(tint.hidden);
        CHECK_FALSE(tint.tested);
        CHECK(tint.highlighted == (inside || across));
    }
}

TEST_CASE("what lies in one of several showing boxes is shown, unless a hiding box holds it") {
    Clips clips = made({unit(ClipMode::hideOutside), unit(ClipMode::hideOutside, {5, 0, 0}),
                        unit(ClipMode::hideInside, {5.5, 0, 0})});
    CHECK_FALSE(clips.hides({0, 0, 0}));
    CHECK_FALSE(clips.hides({4.25, 0, 0}));
    CHECK(clips.hides({5, 0, 0}));
    CHECK(clips.hides({2.5, 0, 0}));
    CHECK(clips.clipVerdict(boxAround({2.5, 0, 0}, 0.5)).hidden);
    CHECK(clips.clipVerdict(boxAround({5.5, 0, 0}, 0.1)).hidden);
}

TEST_CASE("verdicts on nodes are never wrong about a point, with turned boxes far from the origin") {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unitRandom(-1, 1);
    Vec3d far{6.5e6, -4.2e6, 1e3};
    auto at = [&](double reach) {
        return far + Vec3d{unitRandom(random), unitRandom(random), unitRandom(random)} * reach;
    };
    int decided = 0, tested = 0;
    for (int round = 0; round < 400; ++round) {
        std::vector<ClipBox> boxes;
        for (int b = 0; b < 3; ++b) {
            ClipBox box{at(3), {1 + std::abs(unitRandom(random)), 1.5, 2}};
            box.mode = b == 0 ? ClipMode::hideInside : b == 1 ? ClipMode::hideOutside : ClipMode::highlight;
            box.axes = *axesOfQuaternion(unitRandom(random), unitRandom(random), unitRandom(random), 0.5);
            boxes.push_back(box);
        }
        Clips clips = made(boxes);
        Vec3d centre = at(3);
        BoxD node = boxAround(centre, 0.4);
        ClipVerdict verdict = clips.clipVerdict(node);
        Clips near = clips.near(node);
        (verdict.tested ? tested : decided) += 1;
        for (int p = 0; p < 30; ++p) {
            Vec3d point = centre + Vec3d{unitRandom(random), unitRandom(random), unitRandom(random)} * 0.4;
            if (!verdict.tested)
                CHECK(clips.hides(point) == verdict.hidden);
            CHECK(near.hides(point) == clips.hides(point));
            CHECK(near.highlights(point) == clips.highlights(point));
            if (clips.highlights(point) && !verdict.hidden)
                CHECK(verdict.highlighted);
        }
    }
    CHECK(decided > 50);
    CHECK(tested > 50);
}

TEST_CASE("a box that can't be computed with is refused") {
    ClipBox box = unit(ClipMode::hideInside);
    box.halfSize.y = NAN;
    CHECK_FALSE(Clips::make({&box, 1}).ok());
    box.halfSize.y = -1;
    CHECK_FALSE(Clips::make({&box, 1}).ok());
}

TEST_CASE("a footprint holds its edges and those of its holes, and the ends of its heights") {
    ClipRegion foot;
    foot.shape.rings = {{{0, 0}, {8, 0}, {8, 8}, {4, 2}, {0, 8}}, {{1, 1}, {2, 1}, {2, 2}, {1, 2}}};
    foot.shape.heights = ValueRange{-1, 3};
    Clips clips = made({}, {foot});
    for (Vec3d held : {Vec3d{0, 0, -1}, {8, 8, 3}, {4, 2, 0}, {0.5, 0.5, 0}, {1, 1.5, 0}, {4, 1, 3}})
        CHECK_FALSE(clips.hides(held));
    for (Vec3d outside :
         {Vec3d{4, 2.001, 0}, {1.5, 1.5, 0}, {0.5, 0.5, 3.001}, {0.5, 0.5, -1.001}, {9, 1, 0}})
        CHECK(clips.hides(outside));
    CHECK(clips.clipVerdict(boxAround({4, 6, 0}, 0.5)).hidden); // in the notch
    CHECK(clips.clipVerdict(boxAround({1.5, 1.5, 0}, 0.2)).hidden);
    CHECK_FALSE(clips.clipVerdict(boxAround({6, 1, 1}, 0.5)).tested);
    CHECK(clips.clipVerdict(boxAround({6, 1, 3}, 0.5)).tested);
}

TEST_CASE("a ring that touches or crosses itself is by the even-odd rule") {
    ClipRegion bow; // two triangles that meet at (2, 2), where two edges cross
    bow.shape.rings = {{{0, 0}, {4, 4}, {4, 0}, {0, 4}}};
    Clips clips = made({}, {bow});
    CHECK_FALSE(clips.hides({0.5, 2, 0}));
    CHECK_FALSE(clips.hides({3.5, 2, 0}));
    CHECK_FALSE(clips.hides({2, 2, 0}));
    CHECK(clips.hides({2, 3, 0}));
    CHECK(clips.hides({2, 1, 0}));
    ClipRegion star; // wound twice around its middle, which is outside then
    for (int i = 0; i < 5; ++i)
        star.shape.rings.resize(1), star.shape.rings[0].push_back(
                                        {std::cos(i * 2.5132741228718345), std::sin(i * 2.5132741228718345)});
    CHECK(made({}, {star}).hides({0, 0, 0}));
    CHECK_FALSE(made({}, {star}).hides({0.7, 0, 0}));
}

TEST_CASE("regions go together with boxes, mode by mode") {
    ClipRegion line{{}, ClipMode::hideOutside};
    line.shape.line = {{4, 0}, {9, 0}};
    line.shape.width = 2;
    ClipRegion cap{{}, ClipMode::hideInside};
    cap.shape.heights = ValueRange{0.5, std::numeric_limits<double>::infinity()};
    ClipRegion view{{}, ClipMode::highlight};
    view.shape.prism = ScreenPolygon{Vec3d{0, 0, 10}, {0, 0, -1}, {{-1, -1, 5}, {1, -1, 5}, {0, 1, 5}}};
    Clips clips = made({unit(ClipMode::hideOutside)}, {line, cap, view});
    CHECK_FALSE(clips.hides({0, 0, 0}));
    CHECK_FALSE(clips.hides({7, 1, 0}));
    CHECK(clips.hides({7, 1.001, 0}));
    CHECK(clips.hides({2, 0, 0}));
    CHECK(clips.hides({0, 0, 0.5}));
    CHECK(clips.highlights({0, 0, -100}));
    CHECK_FALSE(clips.highlights({0, 0, 11})); // behind the eye
    CHECK(clips.hidesPoints());
    CHECK_FALSE(made({}, {view}).hidesPoints());
    CHECK(hidesPoints([&] {
        ColourStyle style;
        style.clipRegions = {cap};
        return style;
    }()));
}

namespace {

// Of all kinds, around `centre`, some 3 wide.
ClipRegion randomRegion(std::mt19937_64& random, Vec3d centre, int kind) {
    std::uniform_real_distribution<double> unitRandom(-1, 1);
    auto at = [&](double reach) {
        return Point2d{centre.x + reach * unitRandom(random), centre.y + reach * unitRandom(random)};
    };
    ClipRegion region;
    if (kind == 0) {
        region.shape.rings.resize(2);
        for (int i = 0; i < 9; ++i)
            region.shape.rings[0].push_back(at(3)); // crosses itself at will
        for (int i = 0; i < 3; ++i)
            region.shape.rings[1].push_back(at(1));
        region.shape.heights = ValueRange{centre.z - 1, centre.z + 2 * std::abs(unitRandom(random))};
    } else if (kind == 1) {
        region.shape.line = {at(3), at(3), at(3), at(3)};
        region.shape.width = 0.1 + std::abs(unitRandom(random));
    } else {
        ScreenPolygon screen;
        if (kind == 2)
            screen.eye = centre + Vec3d{6 * unitRandom(random), 6 * unitRandom(random), 9};
        screen.forward = {0.1 * unitRandom(random), 0.1 * unitRandom(random), -1};
        for (int i = 0; i < 8; ++i) {
            double turn = i * 0.7853981633974483, reach = i % 2 ? 1 : 3;
            screen.corners.push_back(
                centre + Vec3d{reach * std::cos(turn), reach * std::sin(turn), 0.2 * unitRandom(random)});
        }
        region.shape.prism = screen;
    }
    return region;
}

} // namespace

TEST_CASE("verdicts on nodes are never wrong about a point, with regions of all kinds far from the origin") {
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> unitRandom(-1, 1);
    const Vec3d far{6.5e6, -4.2e6, 1e3};
    int decided = 0, tested = 0, hidden = 0;
    for (int round = 0; round < 400; ++round) {
        ClipRegion region = randomRegion(random, far, round % 4);
        region.mode = round % 3 == 0 ? ClipMode::hideInside : ClipMode::hideOutside;
        Clips clips = made({}, {region});
        region.mode = ClipMode::highlight;
        Clips tint = made({}, {region});
        Vec3d centre = far + Vec3d{unitRandom(random), unitRandom(random), unitRandom(random)} * 3;
        BoxD node = boxAround(centre, 0.4);
        ClipVerdict verdict = clips.clipVerdict(node);
        Clips near = clips.near(node), nearTint = tint.near(node);
        (verdict.tested ? tested : decided) += 1;
        hidden += verdict.hidden;
        for (int p = 0; p < 30; ++p) {
            Vec3d point = centre + Vec3d{unitRandom(random), unitRandom(random), unitRandom(random)} * 0.4;
            if (!verdict.tested)
                CHECK(clips.hides(point) == verdict.hidden);
            CHECK(near.hides(point) == clips.hides(point));
            CHECK(nearTint.highlights(point) == tint.highlights(point));
            if (tint.highlights(point))
                CHECK(tint.clipVerdict(node).highlighted);
        }
    }
    CHECK(decided > 100);
    CHECK(tested > 50);
    CHECK(hidden > 20);
}

TEST_CASE("a region that can't be computed with is refused") {
    auto fails = [](RegionShape shape) { return !Clips::make({}, std::vector{ClipRegion{shape}}).ok(); };
    RegionShape shape;
    shape.rings = {{{0, 0}, {1, 0}}};
    CHECK(fails(shape));
    shape.rings = {{{0, 0}, {1, 0}, {0, NAN}}};
    CHECK(fails(shape));
    shape.rings = {{{0, 0}, {1, 0}, {0, 1e-150}}}; // products of it would be lost
    CHECK(fails(shape));
    shape.rings = {{{0, 0}, {1, 0}, {0, 1}}};
    CHECK_FALSE(fails(shape));
    shape.heights = ValueRange{2, 1};
    CHECK(fails(shape));
}
