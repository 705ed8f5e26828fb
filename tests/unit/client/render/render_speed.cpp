// Points a second of both rasterizers on made-up nodes: client_render_speed [POINTS_MILLION] [WIDTH HEIGHT].
// Points lie on a rough ground seen from above at an angle, in nodes of 40,000, as a scan does.
#include "client/headless/egl_context.hpp"
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

using namespace stipple;
using namespace stipple::test;

namespace {

std::vector<TestNode> ground(int nodesAcross) {
    std::vector<TestNode> nodes;
    TestRandom random(7);
    for (int i = 0; i < nodesAcross * nodesAcross; ++i) {
        TestNode node;
        node.nodeBits = 12; // 41 m
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
            node.points.push_back(point);
        }
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
    double pixels;
    PointShape shape;
    bool edl, world;
};

} // namespace

int main(int argc, char** argv) {
    double million = argc > 1 ? std::atof(argv[1]) : 4;
    int width = argc > 3 ? std::atoi(argv[2]) : 1280, height = argc > 3 ? std::atoi(argv[3]) : 720;
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

    const Case cases[] = {{"1 px", 1, PointShape::square, false, false},
                          {"1 px, EDL 8", 1, PointShape::square, true, false},
                          {"2 px square", 2, PointShape::square, false, false},
                          {"2 px circle", 2, PointShape::circle, false, false},
                          {"2 px circle, EDL 8", 2, PointShape::circle, true, false},
                          {"3 px circle", 3, PointShape::circle, false, false},
                          {"4 px circle", 4, PointShape::circle, false, false},
                          {"2.5 px circle", 2.5, PointShape::circle, false, false},
                          {"world size circle", 1, PointShape::circle, false, true}};
    auto context = headless::EglContext::create();
    auto gles =
        context.ok() ? GlesRenderer::create() : Result<std::unique_ptr<GlesRenderer>>(context.error());
    std::printf("%.1f million points, %d x %d; million points a second\n", points * 1e-6, width, height);
    std::printf("%-20s %14s %12s %12s   %s\n", "", "1 thread (CPU)", "1 thread", "2 threads",
                context.ok() ? (*context)->driver().c_str() : "no GLES");
    for (const Case& one : cases) {
        Style style;
        style.sizePixels = one.pixels;
        style.shape = one.shape;
        style.edl.enabled = one.edl;
        style.sizeMode = one.world ? PointSizeMode::world : PointSizeMode::fixed;
        style.sizeWorld = half / 200;
        FramePlan plan = testPlan(nodes, view, style);
        std::printf("%-20s", one.name);
        auto single = SoftwareRenderer::create(1), two = SoftwareRenderer::create(2);
        std::printf(" %14.1f",
                    points * 1e-6 / bestSeconds(Clock::processor, 7, [&] { single->render(plan); }));
        std::printf(" %12.1f", points * 1e-6 / bestSeconds(Clock::wall, 7, [&] { single->render(plan); }));
        std::printf(" %12.1f", points * 1e-6 / bestSeconds(Clock::wall, 7, [&] { two->render(plan); }));
        if (gles.ok()) {
            auto target = (*context)->framebuffer(width, height);
            double seconds = bestSeconds(Clock::wall, 1, [&] {
                (void)(*gles)->draw(plan, *target).ok();
                glFinish();
            });
            std::printf(" %12.1f", points * 1e-6 / seconds);
        }
        std::printf("\n");
    }
}
