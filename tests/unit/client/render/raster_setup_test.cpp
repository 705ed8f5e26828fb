#include "client/core/gradients.hpp"
#include "client/render/raster_setup.hpp"
#include "client/render/worker_pool.hpp"
#include "tests/support/test_plan.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace stipple;
using namespace stipple::test;

TEST_CASE("depth steps fill 24 bits, rise with the distance, and are finer than 4e-6 of it", "[setup]") {
    for (auto [near, far] :
         {std::pair{0.1, 1000.0}, std::pair{1e-3, 1e7}, std::pair{10.0, 10.5}, std::pair{1e-6, 1e3}}) {
        TestView view;
        view.near = near;
        view.far = far;
        RasterFrame frame = rasterFrame(testPlan({}, view));
        auto step = [&](float d) { return (floatBits(d) - frame.nearBits) >> frame.depthShift; };
        CHECK(step(frame.near) == 0);
        CHECK(step(frame.far) < (1u << depthBits));
        std::uint32_t last = 0;
        for (double d = near; d < far; d *= 1 + 4e-6 * 1000) {
            auto here = static_cast<float>(d), behind = static_cast<float>(d * (1 + 4e-6));
            REQUIRE(step(here) >= last);
            if (behind <= frame.far)
                REQUIRE(step(behind) > step(here));
            last = step(here);
        }
    }
}

TEST_CASE("draw order is near to far and does not depend on the plan's", "[setup]") {
    std::vector<TestNode> nodes;
    for (double y : {30.0, 0.0, 20.0, 10.0})
        nodes.push_back(randomNode(1, 5, 8, {0, y, 0}, 0.01));
    nodes.push_back(TestNode{}); // without points: left out
    FramePlan plan = testPlan(nodes, {});
    CHECK(drawOrder(plan) == std::vector<std::size_t>{1, 3, 2, 0});
    auto keys = [](const FramePlan& p) {
        std::vector<NodeKey> all;
        for (std::size_t i : drawOrder(p))
            all.push_back(p.nodes[i].node->key);
        return all;
    };
    auto expected = keys(plan);
    std::reverse(plan.nodes.begin(), plan.nodes.end());
    CHECK(keys(plan) == expected);
}

TEST_CASE("eye-dome neighbours lie around the pixel, never on it", "[setup]") {
    for (int neighbours : {4, 8})
        for (double radius : {0.0, 0.3, 1.0, 1.4, 2.5, 1e9}) {
            EyeDomeLighting style;
            style.neighbours = neighbours;
            style.radiusPixels = radius;
            EdlSetup setup = edlSetup(style);
            CHECK(setup.enabled);
            CHECK(setup.neighbours == neighbours);
            int sumX = 0, sumY = 0;
            for (int i = 0; i < neighbours; ++i) {
                auto [x, y] = setup.offsets[static_cast<std::size_t>(i)];
                CHECK((x != 0 || y != 0));
                CHECK(std::max(std::abs(x), std::abs(y)) <= 64);
                sumX += x;
                sumY += y;
            }
            CHECK(sumX == 0);
            CHECK(sumY == 0);
        }
}

TEST_CASE("gradients are smooth, opaque, and have names that read back", "[gradients]") {
    for (int g = 0; g < 6; ++g) {
        auto name = static_cast<GradientName>(g);
        INFO(gradientNameText(name));
        CHECK(gradientFromText(gradientNameText(name)) == name);
        const GradientTable& table = gradientTable(name);
        int largest = 0;
        for (std::size_t i = 1; i < table.size(); ++i) {
            REQUIRE(table[i] >> 24 == 255);
            for (int shift : {0, 8, 16})
                largest = std::max(largest, std::abs(static_cast<int>(table[i] >> shift & 255) -
                                                     static_cast<int>(table[i - 1] >> shift & 255)));
        }
        CHECK(largest <= 4);
    }
    CHECK_FALSE(gradientFromText("rainbow").has_value());
    CHECK(gradientTable(GradientName::viridis).front() == 0xFF540144u); // #440154
    CHECK(gradientTable(GradientName::viridis).back() == 0xFF25E7FDu);  // #FDE725
}

TEST_CASE("gradients that are safe for colour-blind eyes grow lighter all the way", "[gradients]") {
    for (int g = 0; g < 6; ++g) {
        auto name = static_cast<GradientName>(g);
        if (!isColourBlindSafe(name))
            continue;
        INFO(gradientNameText(name));
        // Luma (Rec. 709) over a 32nd of the gradient; single entries are rounded to levels.
        const GradientTable& table = gradientTable(name);
        auto luma = [&](std::size_t i) {
            return 0.2126 * (table[i] & 255) + 0.7152 * (table[i] >> 8 & 255) +
                   0.0722 * (table[i] >> 16 & 255);
        };
        for (std::size_t i = 32; i < table.size(); i += 32)
            CHECK(luma(i) > luma(i - 32));
    }
}

TEST_CASE("every piece of work is done exactly once", "[workers]") {
    for (int threads : {1, 2, 5}) {
        WorkerPool pool(threads);
        CHECK(pool.threads() == threads);
        for (std::size_t count : {0u, 1u, 2u, 1000u}) {
            std::vector<std::atomic<int>> done(count);
            pool.run(count, [&](std::size_t i) { ++done[i]; });
            CHECK(std::all_of(done.begin(), done.end(), [](const auto& n) { return n == 1; }));
        }
    }
}
