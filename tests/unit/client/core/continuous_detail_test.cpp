#include "client/core/continuous_detail.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>

using namespace stipple;

namespace {

double spacingAt(const RankDensity& density, double rank) {
    return 1 / std::sqrt(density.base + density.step * rank);
}

// Points per area of a plane that is filled evenly down to `levels`, each node with `perNode` points more
// than its ancestors have there, where the target spacing is `target`.
double planeDensity(double target, int levels, double rootSide, std::uint32_t rootPoints) {
    double density = 0, rootSpacing = rootSide / std::sqrt(rootPoints);
    for (int level = 0; level <= levels; ++level) {
        std::uint32_t points = level == 0 ? rootPoints : rootPoints / 4 * 3;
        RankDensity ranks = rankDensity(level, std::ldexp(rootSpacing, -level), points);
        double shown = (1 / (target * target) - ranks.base) / ranks.step + 0.5; // the middle of the last rank
        double area = std::ldexp(rootSide * rootSide, -2 * level);
        density += std::clamp(shown, 0.0, double(points)) / area;
    }
    return density;
}

} // namespace

TEST_CASE("spacings fall from twice the node's to the node's, and go on where the parent ends") {
    const double spacing = 0.25;
    RankDensity node = rankDensity(3, spacing, 12'000);
    CHECK(spacingAt(node, -0.5) == Approx(2 * spacing).epsilon(1e-12));
    CHECK(spacingAt(node, 11'999.5) == Approx(spacing).epsilon(1e-12));
    RankDensity child = rankDensity(4, spacing / 2, 500);
    CHECK(spacingAt(child, -0.5) == Approx(spacingAt(node, 11'999.5)).epsilon(1e-12));
    // The root begins with one point for all.
    RankDensity root = rankDensity(0, spacing, 16);
    CHECK(spacingAt(root, 0.5) == Approx(4 * spacing).epsilon(1e-12));
    CHECK(spacingAt(root, 15.5) == Approx(spacing).epsilon(1e-12));
}

TEST_CASE("the density of a plane follows the target through ten levels without a step") {
    const int levels = 10;
    const double side = 1024;
    const std::uint32_t rootPoints = 16'384;
    double worst = 0, last = 0;
    for (double target = side / 20; target > std::ldexp(side / 128, -levels); target /= 1.003) {
        double density = planeDensity(target, levels, side, rootPoints), wanted = 1 / (target * target);
        worst = std::max(worst, std::abs(density / wanted - 1));
        CHECK(density >= last); // nothing is lost on the way closer
        last = density;
    }
    CHECK(worst < 1e-12);
}

TEST_CASE("a prefix holds the points whose spacing exceeds the target, and no others") {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int round = 0; round < 400; ++round) {
        std::uint32_t points = 1 + static_cast<std::uint32_t>(20'000 * unit(random));
        double spacing = std::exp2(20 * unit(random) - 10),
               target = spacing * std::exp2(4 * unit(random) - 2);
        RankDensity density = rankDensity(round % 5, spacing, points);
        std::uint32_t shown = 0;
        while (shown < points && spacingAt(density, shown) > target)
            ++shown;
        std::uint32_t prefix = detailPrefix(density, points, target);
        CHECK(prefix >= shown);
        CHECK(prefix <= shown + 1 + points / 10'000); // its slack for comparisons in float
        double pixel = spacing * std::exp2(6 * unit(random) - 3);
        CHECK((reachPixels(density, pixel) > target / pixel) == (shown > 0));
    }
    CHECK(detailPrefix(rankDensity(2, 1, 100), 100, 1e-200) == 100);
    CHECK(detailPrefix(rankDensity(2, 1, 100), 100, 1e200) == 0);
}

TEST_CASE("the reach of a node is never larger than its parent's") {
    for (std::uint32_t parentPoints : {1u, 2u, 50u, 30'000u})
        for (std::uint32_t points : {1u, 7u, 30'000u})
            for (int level : {0, 1, 6}) {
                RankDensity parent = rankDensity(level, 1, parentPoints),
                            child = rankDensity(level + 1, 0.5, points);
                CHECK(spacingAt(child, 0) <= spacingAt(parent, 0));
            }
}
