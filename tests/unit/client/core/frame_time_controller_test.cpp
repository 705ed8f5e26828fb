#include "client/core/frame_time_controller.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace stipple;

namespace {
// Frames whose time falls with the number of points: `fixed` + `drawing` / factor².
double settledTime(FrameTimeController& controller, double fixed, double drawing, double wanted, int frames) {
    double took = 0;
    for (int i = 0; i < frames; ++i) {
        took = fixed + drawing / (controller.factor() * controller.factor());
        controller.frameTook(took, wanted);
    }
    return took;
}
} // namespace

TEST_CASE("frames that are too slow come near the wanted time, from any load") {
    for (double load : {0.03, 0.1, 0.5, 3.0}) {
        FrameTimeController controller;
        double took = settledTime(controller, 0.002, load, 0.02, 60);
        CHECK(took <= 1.1 * 0.02);
        CHECK(took >= 0.75 * 0.02); // not coarser than it must be
    }
}

TEST_CASE("frames that are quick stay as fine as asked for, and become so again") {
    FrameTimeController controller;
    settledTime(controller, 0.001, 0.01, 0.02, 20);
    CHECK(controller.factor() == 1);
    settledTime(controller, 0.001, 1, 0.02, 40);
    CHECK(controller.factor() > 4);
    settledTime(controller, 0.001, 0.001, 0.02, 40);
    CHECK(controller.factor() == 1);
}

TEST_CASE("a frame near its time changes nothing, so that nothing flickers") {
    FrameTimeController controller;
    for (int i = 0; i < 12; ++i)
        controller.frameTook(0.1, 0.02);
    double factor = controller.factor();
    for (double took : {0.0181, 0.02, 0.0219})
        CHECK_FALSE(controller.frameTook(took, 0.02));
    CHECK(controller.factor() == factor);
    CHECK(controller.reset());
    CHECK(controller.factor() == 1);
    CHECK_FALSE(controller.reset());
}

TEST_CASE("no frame makes the factor leave its range, and times that are none are passed over") {
    FrameTimeController controller;
    for (int i = 0; i < 100; ++i)
        controller.frameTook(1e9, 1e-3);
    CHECK(controller.factor() == FrameTimeController::most);
    for (double took : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
        CHECK_FALSE(controller.frameTook(took, 0.02));
    CHECK_FALSE(controller.frameTook(0.1, 0));
    for (int i = 0; i < 100; ++i)
        controller.frameTook(1e-9, 1);
    CHECK(controller.factor() == 1);
}
