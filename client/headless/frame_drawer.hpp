// A frame plan to a picture with either renderer; GLES with a context of its own.
#pragma once

#include "client/core/frame_plan.hpp"
#include "client/render/image.hpp"
#include "shared/base/result.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stipple::headless {

enum class Backend { software, gles };

class FrameDrawer {
  public:
    // `threads`: of the software renderer; 0: one per core. Errors: unsupported where there is no OpenGL
    // ES 3.
    static Result<std::unique_ptr<FrameDrawer>> create(Backend backend, int threads);
    virtual ~FrameDrawer() = default;

    // Draws and, with GLES, reads the picture back, which waits for the GPU. Adds to plan.counters. The
    // picture is kept until the next call.
    virtual Result<const Image*> draw(FramePlan& plan) = 0;
    // View distances of the plan that was drawn last; see GlesRenderer::distances.
    virtual Result<std::vector<float>> distances(const FramePlan& plan) = 0;
    virtual std::string name() const = 0; // "software", or the GL driver
    // GlesRenderer::limitation of the plan that was drawn last.
    virtual std::string limitation() const { return {}; }
};

} // namespace stipple::headless
