// Points a second of both rasterizers on made-up nodes: client_render_speed [POINTS_MILLION] [WIDTH HEIGHT]
// [GLES 1 or 0] [PART: all, cases, discs or expansion]. Points lie on a rough ground seen from above at an
// angle, in nodes of 40,000, as a scan does. Cases are the ways of drawing; then what discs cost against
// circles, and what delayed expansion gains and how far its picture is from that of drawing at once.
#include "client/headless/egl_context.hpp"
#include "client/measure/pixel_error.hpp"
#include "client/render/gles_renderer.hpp"
#include "client/render/software_renderer.hpp"
#include "tests/support/test_plan.hpp"

#include <GLES3/gl3.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>

using namespace stipple;
using namespace stipple::test;

namespace {

std::vector<TestNode> ground(int nodesAcross) {
    std::vector<TestNode> nodes;
    TestRandom random(7);
    for (int i = 0; i < nodesAcross * nodesAcross; ++i) {
        TestNode node;
        node.nodeBits = 12; // 41 m
        node.key = {12, static_cast<std::uint32_t>(i % nodesAcross),
                    static_cast<std::uint32_t>(i / nodesAcross), 0};
        node.spacing = 0.2;
        node.corner = {(i % nodesAcross - nodesAcross / 2) * 40.96,
                       (i / nodesAcross - nodesAcross / 2) * 40.96, 0};
        for (int p = 0; p < 40000; ++p) {
            TestPoint point;
            point.x = random.below(4096);
            point.y = random.below(4096);
            point.z =
                static_cast<std::uint32_t>(200 + 150 * std::sin(point.x * 0.004) * std::cos(point.y * 0.003));
            point.r = static_cast<std::uint8_t>(point.x >> 4);
            point.g = static_cast<std::uint8_t>(point.y >> 4);
            point.normal = {static_cast<float>(-0.6 * std::cos(point.x * 0.004) * std::cos(point.y * 0.003)),
                            static_cast<float>(0.45 * std::sin(point.x * 0.004) * std::sin(point.y * 0.003)),
                            1};
            node.points.push_back(point);
        }
        node.hasNormals = true;
        nodes.push_back(std::move(node));
    }
    return nodes;
}

// The best of several runs. Processor time: what one core does while it is ours, also on a busy machine.
enum class Clock { wall, processor };
double secondsNow(Clock clock) {
    timespec time{};
    clock_gettime(clock == Clock::wall ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}
double bestSeconds(Clock clock, int runs, const std::function<void()>& work) {
    work();
    double best = 1e9;
    for (int i = 0; i < runs; ++i) {
        double start = secondsNow(clock);
        work();
        best = std::min(best, secondsNow(clock) - start);
    }
    return best;
}

struct Case {
    const char* name;
    Style style;
};

std::vector<Case> casesFor(double half) {
    std::vector<Case> cases;
    auto add = [&](const char* name, double pixels, PointShape shape, auto change) {
        Style style;
        style.sizePixels = pixels;
        style.shape = shape;
        style.edl.enabled = false;
        change(style);
        cases.push_back({name, style});
    };
    constexpr auto asIs = [](Style&) {};
    constexpr auto lit = [](Style& style) { style.edl.enabled = true; };
    constexpr auto blended = [](Style& style) { style.splats.enabled = true; };
    add("1 px", 1, PointShape::square, asIs);
    add("1 px, EDL 8", 1, PointShape::square, lit);
    add("2 px square", 2, PointShape::square, asIs);
    add("2 px circle", 2, PointShape::circle, asIs);
    add("2 px circle, EDL 8", 2, PointShape::circle, lit);
    add("3 px square", 3, PointShape::square, asIs);
    add("3 px circle", 3, PointShape::circle, asIs);
    add("4 px circle", 4, PointShape::circle, asIs);
    add("2.5 px circle", 2.5, PointShape::circle, asIs);
    add("world size circle", 1, PointShape::circle, [half](Style& style) {
        style.sizeMode = PointSizeMode::world;
        style.sizeWorld = half / 200;
    });
    add("adaptive circle", 1, PointShape::circle, [](Style& style) {
        style.sizeMode = PointSizeMode::adaptive;
        style.sizeSpacings = 1;
    });
    add("3 px disc", 3, PointShape::disc, asIs);
    add("5 px disc", 5, PointShape::disc, asIs);
    add("3 px disc splats", 3, PointShape::disc, blended);
    add("2 px splats", 2, PointShape::circle, blended);
    add("3 px splats", 3, PointShape::circle, blended);
    add("3 px splats, EDL 8", 3, PointShape::circle,
        [](Style& style) { style.splats.enabled = style.edl.enabled = true; });
    return cases;
}

// Either rasterizer, drawing a plan once.
using Draw = std::function<Image(FramePlan&)>;

void compareExpansion(const char* name, const Draw& draw, const std::vector<TestNode>& nodes,
                      const TestView& view, Clock clock, int runs) {
    struct Kind {
        const char* name;
        double pixels;
        bool splats;
    };
    for (const Kind& kind : {Kind{"2 px circle", 2, false},
                             {"3 px circle", 3, false},
                             {"5 px circle", 5, false},
                             {"2 px splats", 2, true},
                             {"3 px splats", 3, true},
                             {"5 px splats", 5, true}}) {
        Style style;
        style.sizePixels = kind.pixels;
        style.edl.enabled = false;
        style.splats.enabled = kind.splats;
        FramePlan atOnce = testPlan(nodes, view, style);
        style.delayedExpansion = DelayedExpansion::on;
        FramePlan late = testPlan(nodes, view, style);
        double slow = 1e9, quick = 1e9; // interleaved
        for (int i = 0; i < runs; ++i) {
            slow = std::min(slow, bestSeconds(clock, 1, [&] { draw(atOnce); }));
            quick = std::min(quick, bestSeconds(clock, 1, [&] { draw(late); }));
        }
        double error = measure::pixelError(draw(atOnce), draw(late)).mean;
        std::printf("%-9s %-12s %10.1f ms %10.1f ms %+8.0f %% frames, mean error %.2f levels (%.2f %%)\n",
                    name, kind.name, 1e3 * slow, 1e3 * quick, 100 * (slow / quick - 1), error, error / 2.55);
    }
}

// Discs against circles of the same size, one after the other in turn.
void compareDiscs(const Draw& draw, const std::vector<TestNode>& nodes, const TestView& view, Clock clock,
                  int runs) {
    for (double pixels : {2.0, 3.0, 5.0, 9.0, 20.0})
        for (bool splats : {false, true}) {
            Style style;
            style.sizePixels = pixels;
            style.edl.enabled = false;
            style.splats.enabled = splats;
            FramePlan circles = testPlan(nodes, view, style);
            style.shape = PointShape::disc;
            FramePlan discs = testPlan(nodes, view, style);
            double circle = 1e9, disc = 1e9;
            for (int i = 0; i < runs; ++i) {
                circle = std::min(circle, bestSeconds(clock, 1, [&] { draw(circles); }));
                disc = std::min(disc, bestSeconds(clock, 1, [&] { draw(discs); }));
            }
            std::printf("%4.0f px %-8s circles %8.1f ms, discs %8.1f ms: %.2f times\n", pixels,
                        splats ? "splats" : "", 1e3 * circle, 1e3 * disc, disc / circle);
        }
}

// Either rasterizer's speed in each way of drawing; `gles` null: software alone.
void printCases(const std::vector<TestNode>& nodes, const TestView& view, double half, double points,
                headless::EglContext* context, GlesRenderer* gles) {
    std::printf("%-20s %14s %12s %12s   %s\n", "", "1 thread (CPU)", "1 thread", "2 threads",
                gles ? context->driver().c_str() : "no GLES");
    auto single = SoftwareRenderer::create(1), two = SoftwareRenderer::create(2);
    for (const Case& one : casesFor(half)) {
        FramePlan plan = testPlan(nodes, view, one.style);
        auto print = [points](double seconds) { std::printf(" %12.1f", points * 1e-6 / seconds); };
        std::printf("%-20s  ", one.name);
        print(bestSeconds(Clock::processor, 7, [&] { single->render(plan); }));
        print(bestSeconds(Clock::wall, 7, [&] { single->render(plan); }));
        print(bestSeconds(Clock::wall, 7, [&] { two->render(plan); }));
        if (gles) {
            auto target = context->framebuffer(view.width, view.height);
            print(bestSeconds(Clock::wall, 1, [&] {
                (void)gles->draw(plan, *target).ok();
                glFinish();
            }));
        }
        std::printf("\n");
    }
}

} // namespace

int main(int argc, char** argv) {
    // Minutes of work a line: each is there when it is known, also in a pipe or a file.
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
    double million = argc > 1 ? std::atof(argv[1]) : 4;
    int width = argc > 3 ? std::atoi(argv[2]) : 1280, height = argc > 3 ? std::atoi(argv[3]) : 720;
    bool withGles = argc <= 4 || std::atoi(argv[4]) != 0;
    int nodesAcross = std::max(1, static_cast<int>(std::lround(std::sqrt(million * 1e6 / 40000))));
    std::vector<TestNode> nodes = ground(nodesAcross);
    double points = 40000.0 * nodesAcross * nodesAcross;
    double half = nodesAcross * 20.48;
    TestView view;
    view.position = {0, -2.2 * half, 1.6 * half};
    view.near = 1;
    view.far = 10 * half;
    view.width = width;
    view.height = height;

    auto context = headless::EglContext::create();
    auto gles = context.ok() && withGles
                    ? GlesRenderer::create()
                    : Result<std::unique_ptr<GlesRenderer>>(Error{ErrorCode::unsupported, "", "", ""});
    const std::string part = argc > 5 ? argv[5] : "all";
    if (part != "all" && part != "cases" && part != "discs" && part != "expansion") {
        std::fprintf(stderr, "client_render_speed: no part '%s'; all, cases, discs or expansion\n",
                     part.c_str());
        return 2;
    }
    auto wanted = [&part](const char* name) { return part == "all" || part == name; };
    std::printf("%.1f million points, %d x %d; million points a second\n", points * 1e-6, width, height);
    if (wanted("cases"))
        printCases(nodes, view, half, points, context.ok() ? context->get() : nullptr,
                   gles.ok() ? gles->get() : nullptr);
    auto single = SoftwareRenderer::create(1);
    auto draw = [&](FramePlan& plan) { return single->render(plan); };
    if (wanted("discs")) {
        std::printf("Discs and circles, software\n");
        compareDiscs(draw, nodes, view, Clock::processor, 5);
    }
    if (!wanted("expansion"))
        return 0;
    std::printf("Drawn at once, and with delayed expansion\n");
    compareExpansion("software", draw, nodes, view, Clock::processor, 3);
    if (gles.ok())
        compareExpansion(
            "gles",
            [&](FramePlan& plan) {
                auto target = (*context)->framebuffer(width, height);
                (void)(*gles)->draw(plan, *target).ok();
                auto image = (*context)->read();
                return image.ok() ? *image : Image();
            },
            nodes, view, Clock::wall, 1);
}
