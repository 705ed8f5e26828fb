#include "client/bench/chart.hpp"
#include "client/bench/statistics.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace stipple::bench;

TEST_CASE("medians and spreads") {
    CHECK(median({}) == 0);
    CHECK(median({3}) == 3);
    CHECK(median({9, 1, 2}) == 2);
    CHECK(median({4, 1, 3, 100}) == 3.5);
    Spread spread = spreadOf({5, 1, 9});
    CHECK(spread.median == 5);
    CHECK(spread.least == 1);
    CHECK(spread.most == 9);
    CHECK(meanOf({1, 2, 6}) == 3);
    CHECK(meanOf({}) == 0);
}

TEST_CASE("the Pareto line holds the points that none beats") {
    std::vector<ChartSeries> series{{"a", {{1, 10, ""}, {2, 5, ""}, {3, 6, ""}}},
                                    {"b", {{2, 4, ""}, {5, 4, ""}, {9, 1, ""}}}};
    auto front = paretoPoints(series);
    REQUIRE(front.size() == 3);
    CHECK(front[0].y == 10);
    CHECK(front[1].x == 2);
    CHECK(front[1].y == 4);
    CHECK(front[2].x == 9);
}

TEST_CASE("ticks are round numbers inside the axis") {
    CHECK(ticksBetween(0, 10, false) == std::vector<double>{0, 2, 4, 6, 8, 10});
    CHECK(ticksBetween(0.9, 21, true) == std::vector<double>{1, 2, 5, 10, 20});
    auto wide = ticksBetween(1e-3, 1e4, true);
    CHECK(wide.size() == 8);
    for (auto [low, high] : {std::pair{0.0, 0.031}, {-3.0, 17.0}, {0.0, 1e6}}) {
        auto ticks = ticksBetween(low, high, false);
        CHECK(ticks.size() >= 3);
        CHECK(ticks.size() <= 8);
        CHECK(ticks.front() >= low);
        CHECK(ticks.back() <= high);
    }
}

TEST_CASE("a chart is one SVG element with a mark for each point that has a place") {
    Chart chart;
    chart.title = "a < b & \"c\"";
    chart.logX = true;
    chart.paretoLine = true;
    chart.series = {{"one", {{1, 2, "x"}, {10, 1, ""}, {0, 3, "no logarithm"}}},
                    {"two", {{5, NAN, ""}, {7, 8, "<y>"}}}};
    std::string svg = svgOf(chart);
    CHECK(svg.rfind("<svg", 0) == 0);
    CHECK(svg.find("</svg>") == svg.size() - 7);
    auto count = [&](const std::string& part) {
        std::size_t n = 0;
        for (std::size_t at = svg.find(part); at != std::string::npos; at = svg.find(part, at + 1))
            ++n;
        return n;
    };
    CHECK(count("<title>") == 3);
    CHECK(count("a &lt; b &amp; &quot;c&quot;") == 1);
    CHECK(count("&lt;y&gt;") == 2);
    CHECK(count("class=\"pareto\"") == 1);
    CHECK(count("nan") == 0);
    CHECK(svgOf({}).find("nothing to show") != std::string::npos);
    // One point alone has an axis around it, too.
    Chart single;
    single.series = {{"one", {{3, 0, ""}}}};
    CHECK(svgOf(single).find("nan") == std::string::npos);
    CHECK(svgOf(single).find("inf") == std::string::npos);
}
