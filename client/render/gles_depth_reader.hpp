// Reads a depth texture back, which OpenGL ES can't do by itself: a pass writes its steps as colours.
#pragma once

#include "client/render/gles_objects.hpp"
#include "client/render/raster_setup.hpp"

#include <vector>

namespace stipple::gles {

class DepthReader {
  public:
    // View distances per pixel, rows from top to bottom, 0 where there is no point. `depth` is a texture of
    // 32-bit float depth, frame.width × frame.height. Waits for the GPU. Changes the framebuffer and program
    // that are bound.
    Result<std::vector<float>> read(const RasterFrame& frame, GLuint depth);

  private:
    Status prepare(int width, int height);

    Program program_;
    VertexArray emptyArray_;
    Framebuffer framebuffer_;
    Texture steps_;
    int width_ = 0, height_ = 0;
};

} // namespace stipple::gles
