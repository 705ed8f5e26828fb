#include "client/reference/canvas.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using namespace stipple;
using reference::Canvas;
using reference::Mark;

namespace {

Style plain() {
    Style style;
    style.edl.enabled = false;
    style.background = {0, 0, 0};
    return style;
}

Mark mark(double x, double y, double diameter, double distance = 10, std::uint64_t order = 0,
          reference::Colour colour = {255, 255, 255}) {
    return {x, y, distance, diameter, order, colour};
}

// Sum of the red levels in units of a whole pixel.
double area(const DepthImage& picture) {
    double sum = 0;
    for (std::size_t i = 0; i < picture.image.rgba.size(); i += 4)
        sum += picture.image.rgba[i];
    return sum / 255;
}

std::size_t covered(const DepthImage& picture) {
    std::size_t count = 0;
    for (float distance : picture.distances)
        count += distance > 0;
    return count;
}

std::vector<Mark> randomMarks(int count) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Mark> marks;
    for (int i = 0; i < count; ++i)
        marks.push_back(
            mark(unit(random) * 40 - 4, unit(random) * 30 - 3, 1 + 5 * unit(random), 10 + unit(random),
                 static_cast<std::uint64_t>(i),
                 {static_cast<float>(255 * unit(random)), static_cast<float>(255 * unit(random)), 90}));
    return marks;
}

} // namespace

TEST_CASE("splats show the weighted mean of what lies within the blend depth, in any order") {
    Style style = plain();
    style.splats = {true, 2, 0.01};
    Mark front = mark(8.5, 8.5, 4, 10, 0, {200, 0, 0}), beside = mark(9.5, 8.5, 4, 10.09, 1, {0, 100, 0});
    Mark behind = mark(8.5, 8.5, 4, 10.4, 2, {0, 0, 255});
    for (Mark* m : {&front, &beside, &behind})
        m->unitsPerPixel = 0.1; // radius 0.2 and 0.01 of the distance: blended down to 10.3 or so
    std::vector<Mark> marks{front, beside, behind};
    for (int turn = 0; turn < 2; ++turn) {
        Canvas canvas(16, 16);
        canvas.draw(marks, style.shape);
        canvas.blend(marks, style);
        DepthImage picture = canvas.finish(style);
        const std::uint8_t* pixel = picture.image.rgba.data() + 4 * (8 * 16 + 8);
        double w0 = 1, w1 = std::pow(1 - 0.25, 2);
        CHECK(pixel[0] == std::lround(200 * w0 / (w0 + w1)));
        CHECK(pixel[1] == std::lround(100 * w1 / (w0 + w1)));
        CHECK(pixel[2] == 0);
        CHECK(picture.distances[8 * 16 + 8] == 10);
        std::reverse(marks.begin(), marks.end());
    }
}

TEST_CASE("a mark covers the pixels whose centres lie inside it, and the one that holds it") {
    auto draw = [](double x, double y, double diameter, PointShape shape) {
        Canvas canvas(16, 16);
        const Mark marks[] = {mark(x, y, diameter)};
        canvas.draw(marks, shape);
        return canvas.finish(plain());
    };
    CHECK(covered(draw(8, 8, 4, PointShape::square)) == 16);
    CHECK(covered(draw(8, 8, 4, PointShape::circle)) == 12); // without the corners
    CHECK(covered(draw(8.5, 8.5, 3, PointShape::circle)) == 9);
    CHECK(covered(draw(8.2, 8.9, 1, PointShape::circle)) == 1);
    CHECK(draw(8.2, 8.9, 1, PointShape::square).distances[8 * 16 + 8] == 10);
    CHECK(covered(draw(0, 0, 4, PointShape::square)) == 4); // reaching in from the corner
    CHECK(covered(draw(-3, 8, 4, PointShape::square)) == 0);
}

TEST_CASE("many samples measure the area of a mark") {
    for (PointShape shape : {PointShape::square, PointShape::circle}) {
        Canvas canvas(32, 32, 16);
        const Mark marks[] = {mark(15.3, 16.7, 11.4)};
        canvas.draw(marks, shape);
        double expected = shape == PointShape::square ? 11.4 * 11.4 : std::numbers::pi * 5.7 * 5.7;
        CHECK(area(canvas.finish(plain())) == Approx(expected).epsilon(0.01));
    }
}

TEST_CASE("the nearest mark shows, of equally near ones that of smaller order, whoever comes first") {
    std::vector<Mark> marks{mark(2, 2, 3, 10, 5, {10, 0, 0}), mark(2, 2, 3, 9, 7, {20, 0, 0}),
                            mark(2, 2, 3, 9, 6, {30, 0, 0})};
    for (int turn = 0; turn < 3; ++turn) {
        std::rotate(marks.begin(), marks.begin() + 1, marks.end());
        Canvas canvas(4, 4);
        canvas.draw(marks, PointShape::square);
        DepthImage picture = canvas.finish(plain());
        CHECK(picture.image.rgba[4 * (1 * 4 + 1)] == 30);
        CHECK(picture.distances[1 * 4 + 1] == 9);
    }
}

TEST_CASE("samples give the mean of shifted pictures, eye-dome lighting included") {
    constexpr int n = 3;
    Style style = plain();
    style.background = {40, 50, 60};
    style.edl.enabled = true;
    style.edl.strength = 0.05;
    std::vector<Mark> marks = randomMarks(150);
    Canvas fine(36, 27, n);
    fine.draw(marks, PointShape::circle);
    DepthImage picture = fine.finish(style);

    std::vector<double> sums(picture.image.rgba.size());
    std::vector<float> nearest(picture.distances.size(), HUGE_VALF);
    for (int i = 0; i < n * n; ++i) {
        std::vector<Mark> shifted = marks;
        for (Mark& m : shifted) {
            m.x += 0.5 - (i % n + 0.5) / n;
            m.y += 0.5 - (i / n + 0.5) / n;
        }
        Canvas canvas(36, 27);
        canvas.draw(shifted, PointShape::circle);
        DepthImage one = canvas.finish(style);
        for (std::size_t k = 0; k < sums.size(); ++k)
            sums[k] += one.image.rgba[k];
        for (std::size_t k = 0; k < nearest.size(); ++k)
            if (one.distances[k] > 0)
                nearest[k] = std::min(nearest[k], one.distances[k]);
    }
    for (std::size_t k = 0; k < sums.size(); ++k)
        REQUIRE(std::abs(picture.image.rgba[k] - sums[k] / (n * n)) <= 1); // each of the nine was rounded
    for (std::size_t k = 0; k < nearest.size(); ++k)
        REQUIRE(picture.distances[k] == (nearest[k] < HUGE_VALF ? nearest[k] : 0));
}

TEST_CASE("eye-dome lighting shades by the logarithm of distances") {
    // A row of pixels at 10, beside it one at 8: equations 4.5 and 4.6 by hand.
    Canvas canvas(9, 1);
    std::vector<Mark> marks;
    for (int x = 0; x < 9; ++x)
        marks.push_back(
            mark(x + 0.5, 0.5, 1, x == 4 ? 8 : 10, static_cast<std::uint64_t>(x), {200, 200, 200}));
    canvas.draw(marks, PointShape::square);
    Style style = plain();
    style.edl = {true, 4, 1, 0.01};
    DepthImage picture = canvas.finish(style);
    double response = std::log2(10.0 / 8) / 4;
    CHECK(picture.image.rgba[4 * 5] == std::lround(200 * std::exp(-response * 300 * 0.01)));
    CHECK(picture.image.rgba[4 * 3] == picture.image.rgba[4 * 5]);
    CHECK(picture.image.rgba[4 * 4] == 200);
    CHECK(picture.image.rgba[4 * 6] == 200);
}

TEST_CASE("doubt falls on pixels whose mark is about to change, and on no others") {
    Canvas canvas(24, 8);
    // Its edge runs through the centres of the pixels at x = 2 and 5 but for 0.005; another mark is as near
    // but for 10^-6; a third is alone and well inside its pixels.
    const std::vector<Mark> marks{mark(4, 4, 3.01, 10, 1), mark(12, 4, 3.5, 10, 2),
                                  mark(12, 4, 3.5, 10.00001, 3), mark(20, 4, 3.5, 10, 4)};
    canvas.draw(marks, PointShape::square);
    Style square;
    square.shape = PointShape::square;
    canvas.doubt(marks, square, {});
    Style style = plain();
    std::vector<bool> doubtful = canvas.doubtful(style);
    auto at = [&](std::size_t x, std::size_t y) { return bool(doubtful[y * 24 + x]); };
    CHECK(at(2, 4));
    CHECK(at(5, 4));
    CHECK_FALSE(at(3, 4));
    CHECK(at(12, 4));
    CHECK_FALSE(at(20, 4));
    CHECK_FALSE(at(8, 4));
    // Lighting carries it to the neighbours.
    style.edl.enabled = true;
    doubtful = canvas.doubtful(style);
    CHECK(at(6, 4));
    CHECK_FALSE(at(8, 4));
}
