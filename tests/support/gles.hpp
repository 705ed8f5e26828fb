// One OpenGL ES context for a test program, or the reason why there is none.
#pragma once

#include "client/headless/egl_context.hpp"
#include "client/render/gles_renderer.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace stipple::test {

// Made on first use and kept; nullptr where EGL is not available.
inline headless::EglContext* eglContext() {
    static auto context = headless::EglContext::create();
    if (!context.ok()) {
        WARN("skipped: " << context.error().sentence());
        return nullptr;
    }
    return context.value().get();
}

// Mesa's and ANGLE's software drivers compute in IEEE single precision as written, so their depths are
// exactly the software renderer's. A GPU fuses multiplications with additions and divides to within a few
// units in the last place: a distance may come out a step further, and a point in the next 1/128 of a pixel.
inline bool isExact(const headless::EglContext& context) {
    std::string driver = context.driver();
    for (const char* name : {"llvmpipe", "softpipe", "SwiftShader"})
        if (driver.find(name) != std::string::npos)
            return true;
    return false;
}

// How many of so many pixels may differ by more than a test's levels: 1 in 2000; with a GPU 1 in 100 (an
// H200: at most 0.96 % in one scene, 0.1 % in all; the scenes are small and their points big).
inline std::size_t allowedPixels(const headless::EglContext& context, std::size_t pixels) {
    return pixels / (isExact(context) ? 2000 : 100);
}

// Whether view distances agree: all of them; with a GPU all but 1 in 50 to 1e-5 of the distance.
inline bool distancesAgree(const headless::EglContext& context, const std::vector<float>& gles,
                           const std::vector<float>& software) {
    if (isExact(context) || gles.size() != software.size())
        return gles == software;
    std::size_t apart = 0;
    for (std::size_t i = 0; i < gles.size(); ++i)
        apart += std::abs(gles[i] - software[i]) > 1e-5f * software[i];
    return apart <= gles.size() / 50;
}

// The picture that `renderer` draws of `plan`.
inline Image glesPicture(headless::EglContext& context, GlesRenderer& renderer, FramePlan& plan) {
    auto target = context.framebuffer(plan.width, plan.height);
    REQUIRE(target.ok());
    Status drawn = renderer.draw(plan, *target);
    INFO((drawn.ok() ? "" : drawn.error().sentence()));
    REQUIRE(drawn.ok());
    auto image = context.read();
    REQUIRE(image.ok());
    return *std::move(image);
}

} // namespace stipple::test
