// An OpenGL ES 3 context without a window or display server: EGL on a GPU device or, without one, Mesa's
// software driver. Pictures are drawn into a framebuffer object of its own.
#pragma once

#include "client/render/image.hpp"
#include "shared/base/result.hpp"

#include <memory>
#include <string>

namespace stipple::headless {

class EglContext {
  public:
    // Makes a context and makes it current on this thread, where it stays until destroyed. Tried in turn:
    // the surfaceless platform, the EGL devices, the default display. Error: unsupported, saying what each
    // answered.
    static Result<std::unique_ptr<EglContext>> create();
    virtual ~EglContext() = default;

    // A framebuffer (RGBA8, 24-bit depth) of that size, kept until the next call with another size.
    virtual Result<unsigned> framebuffer(int width, int height) = 0;
    // The pixels of the framebuffer of the last call, rows from top to bottom.
    virtual Result<Image> read() = 0;
    // The driver's name for itself: "Mesa llvmpipe (LLVM 15, 256 bits)".
    virtual std::string driver() const = 0;
};

} // namespace stipple::headless
