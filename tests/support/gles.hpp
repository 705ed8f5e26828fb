// One OpenGL ES context for a test program, or the reason why there is none.
#pragma once

#include "client/headless/egl_context.hpp"
#include "client/render/gles_renderer.hpp"

#include <catch2/catch.hpp>

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
