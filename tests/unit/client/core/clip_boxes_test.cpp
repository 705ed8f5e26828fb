#include "client/core/clip_boxes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>

using namespace stipple;

namespace {

ClipBoxes made(std::vector<ClipBox> boxes) {
    auto clips = ClipBoxes::make(boxes);
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
    ClipBoxes none;
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
    ClipBoxes clips = made({unit(ClipMode::hideOutside), unit(ClipMode::hideOutside, {5, 0, 0}),
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
        ClipBoxes clips = made(boxes);
        Vec3d centre = at(3);
        BoxD node = boxAround(centre, 0.4);
        ClipVerdict verdict = clips.clipVerdict(node);
        ClipBoxes near = clips.near(node);
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
    CHECK_FALSE(ClipBoxes::make({&box, 1}).ok());
    box.halfSize.y = -1;
    CHECK_FALSE(ClipBoxes::make({&box, 1}).ok());
}
