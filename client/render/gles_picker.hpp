// Which points the pixels near a pointer show, read back without stalling: the identities are drawn into a
// small buffer of their own, copied by the GPU into a pixel buffer, and taken from there once a fence says so
// (OpenGL ES 3.0 §4.3.2, §5.2).
#pragma once

#include "client/render/gles_objects.hpp"
#include "client/render/pick.hpp"

#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

namespace stipple::gles {

class Picker {
  public:
    // For delayed expansion, before begin(): the same for the points as single pixels, in target.centres,
    // with their places (`COLLECT` and `IDENTITY` of points.frag.glsl).
    Status beginCentres(const PickTarget& target);
    // Binds them to the texture units that expand.vert.glsl reads, or nothing: a texture may not stay
    // readable while the next question draws into it.
    void bindCentres(bool bound) const;

    // Binds and clears what identities are drawn into: those of target.nodes, by their place there
    // (`IDENTITY` of points.frag.glsl), with the viewport that is set now. What was asked before is
    // forgotten.
    Status begin(const PickTarget& target);
    // They are drawn: asks for them.
    void finish(PickTarget target);

    bool pending() const { return static_cast<bool>(fence_); }
    // The answer if it is here; nothing while the GPU is busy, or when nothing was asked. Never waits.
    Result<std::optional<PickAnswer>> take();

  private:
    struct FenceDeleter {
        void operator()(GLsync fence) const { glDeleteSync(fence); }
    };

    Status prepare();
    Status prepareCentres();
    std::vector<PickSample> readSamples() const;

    PickTarget target_;
    Framebuffer framebuffer_;
    Texture identities_, depth_;
    Framebuffer centresFramebuffer_;
    Texture centrePoints_, centrePlaces_, centreDepth_;
    Buffer pixels_;
    std::unique_ptr<std::remove_pointer_t<GLsync>, FenceDeleter> fence_;
};

} // namespace stipple::gles
