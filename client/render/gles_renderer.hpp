// Draws a frame plan with OpenGL ES 3.0: WebGL2 in browsers, EGL natively; the same shader files.
// Needs a current context, and stays on its thread.
#pragma once

#include "client/core/frame_plan.hpp"
#include "client/render/pick.hpp"
#include "shared/base/result.hpp"

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace stipple {

namespace gles {
// What of floating-point colour buffers a context can blend into: nothing, 16 bits, 32 bits.
enum class FloatBlending { none, half, full };
} // namespace gles

class GlesRenderer {
  public:
    // unsupported: the context lacks a feature that is needed, or a shader does not compile (with its log).
    // `mostBlending`, `mostPointPixels`: to try what happens where a context has less.
    static Result<std::unique_ptr<GlesRenderer>>
    create(gles::FloatBlending mostBlending = gles::FloatBlending::full,
           int mostPointPixels = maxPointPixels);
    virtual ~GlesRenderer() = default; // frees every GL object; the context must still be current

    // Draws the plan's part into framebuffer `target` (0: the default one), from its lower left corner.
    // Uploads nodes it has not seen, frees buffers of nodes that it does not draw.
    virtual Status draw(FramePlan& plan, unsigned target = 0) = 0;
    // View distance of the point that each pixel of that plan shows, rows from top to bottom; 0 where there
    // is none. Draws the points once more, into a buffer of its own, and waits for the GPU: for measuring.
    virtual Result<std::vector<float>> distances(const FramePlan& plan) = 0;

    // Asks which point the pointer is on, in the picture that draw() would give of the plan. One question at
    // a time: a new one takes the place of one that was not answered. Changes the framebuffer that is bound.
    virtual Status startPick(const FramePlan& plan, const PickRequest& request) = 0;
    // The answer, once; nothing while the GPU has not given it, or when nothing was asked. Never waits.
    virtual Result<std::optional<PickAnswer>> takePick() = 0;
    virtual bool pickPending() const = 0;

    virtual std::uint64_t gpuBytes() const = 0;
    // What the last plan asked for that this context can't do, and what was drawn instead: a sentence. Empty:
    // nothing.
    virtual const Phrase& limitation() const = 0;
};

} // namespace stipple
