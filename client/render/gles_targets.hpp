// What the OpenGL ES renderer draws into before the picture is finished.
#pragma once

#include "client/render/gles_objects.hpp"
#include "client/render/gles_renderer.hpp"

#include <cstdint>

namespace stipple::gles {

// A texture of that size without levels or filtering, bound to unit 0. What it held before is gone.
void makeTexture(Texture& texture, GLenum format, int width, int height);

// Colour and depth of the points before the resolve pass. Both are core in OpenGL ES 3.0: RGBA8, and 32-bit
// float depth that shaders can read, whose steps q / 2^24 are exact.
struct PointTarget {
    Framebuffer framebuffer;
    Texture colour, depth;
    int width = 0, height = 0;

    std::uint64_t bytes() const {
        return 8ull * static_cast<unsigned>(width) * static_cast<unsigned>(height);
    }

    // Error: unsupported, where the driver refuses such buffers.
    Status resize(int newWidth, int newHeight);
};

// The nearest points as single pixels, for delayed expansion: colour, place and size (expand.vert.glsl), the
// normals of discs, depth.
struct CentreTarget {
    Framebuffer framebuffer;
    Texture colour, place, depth;
    int width = 0, height = 0;
    bool normals = false;

    std::uint64_t bytes() const {
        return (normals ? 16ull : 12ull) * static_cast<unsigned>(width) * static_cast<unsigned>(height);
    }
    // Error: unsupported, where the driver refuses such buffers.
    Status resize(int newWidth, int newHeight, bool withNormals);
};

FloatBlending floatBlending(); // of the current context

// Sums of weighted colours, and of weights in alpha.
struct SumTarget {
    Framebuffer framebuffer;
    Texture sums;
    int width = 0, height = 0;
    FloatBlending kind = FloatBlending::none;

    std::uint64_t bytes() const {
        return (kind == FloatBlending::full ? 16ull : 8ull) * static_cast<unsigned>(width) *
               static_cast<unsigned>(height);
    }
    // `wanted` is not none. Error: unsupported, where the driver refuses such a buffer.
    Status resize(int newWidth, int newHeight, FloatBlending wanted);
};

} // namespace stipple::gles
