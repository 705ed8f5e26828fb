#include "client/headless/egl_context.hpp"

#include "client/render/gles_objects.hpp"
#include "shared/base/text.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>

#include <array>
#include <cstring>
#include <vector>

namespace stipple::headless {
namespace {

struct Named {
    EGLDisplay display;
    std::string name;
};

bool listHas(const char* list, const char* word) {
    std::string padded = cat(" ", list ? list : "", " ");
    return padded.find(cat(" ", word, " ")) != std::string::npos;
}

template <class Function>
Function eglFunction(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

// Displays worth trying, best first. GPU devices come before the surfaceless platform, which may choose a
// software driver; devices that are themselves software come last of the devices by EGL's own order.
std::vector<Named> candidateDisplays() {
    std::vector<Named> found;
    const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    auto getPlatformDisplay = eglFunction<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    auto queryDevices = eglFunction<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    if (getPlatformDisplay && queryDevices && listHas(extensions, "EGL_EXT_platform_device")) {
        std::array<EGLDeviceEXT, 16> devices{};
        EGLint count = 0;
        if (queryDevices(static_cast<EGLint>(devices.size()), devices.data(), &count))
            for (EGLint i = 0; i < count; ++i)
                found.push_back({getPlatformDisplay(EGL_PLATFORM_DEVICE_EXT,
                                                    devices[static_cast<std::size_t>(i)], nullptr),
                                 cat("device ", i)});
    }
    if (getPlatformDisplay && listHas(extensions, "EGL_MESA_platform_surfaceless"))
        found.push_back(
            {getPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr), "surfaceless"});
    found.push_back({eglGetDisplay(EGL_DEFAULT_DISPLAY), "default display"});
    return found;
}

class EglSurfacelessContext final : public EglContext {
  public:
    ~EglSurfacelessContext() override {
        // GL objects go while the context is still current.
        target_ = gles::Framebuffer();
        colour_ = gles::Texture();
        depth_ = gles::Texture();
        if (display_ == EGL_NO_DISPLAY)
            return;
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (context_ != EGL_NO_CONTEXT)
            eglDestroyContext(display_, context_);
        eglTerminate(display_);
    }

    // Returns what went wrong, or nullptr.
    const char* open(EGLDisplay display) {
        if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr))
            return "no display";
        display_ = display;
        if (!listHas(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context"))
            return "no surfaceless contexts";
        eglBindAPI(EGL_OPENGL_ES_API);
        const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        if (!eglChooseConfig(display, wanted, &config, 1, &count) || count < 1)
            return "no configuration for OpenGL ES 3";
        const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0, EGL_NONE};
        context_ = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
        if (context_ == EGL_NO_CONTEXT)
            return "no OpenGL ES 3 context";
        if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
            return "the context can't be made current";
        return nullptr;
    }

    Result<unsigned> framebuffer(int width, int height) override {
        if (target_ && width == width_ && height == height_)
            return target_.id();
        colour_ = gles::Texture();
        depth_ = gles::Texture();
        glBindTexture(GL_TEXTURE_2D, colour_.make());
        glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, width, height);
        glBindTexture(GL_TEXTURE_2D, depth_.make());
        glTexStorage2D(GL_TEXTURE_2D, 1, GL_DEPTH_COMPONENT24, width, height);
        glBindTexture(GL_TEXTURE_2D, 0);
        glBindFramebuffer(GL_FRAMEBUFFER, target_.make());
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_.id(), 0);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.id(), 0);
        STIPPLE_CHECK(gles::checkGl(cat("making a picture of ", width, " × ", height, " pixels").c_str()));
        if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
            return Error{ErrorCode::limitExceeded,
                         cat("the driver can't make a picture of ", width, " × ", height, " pixels"),
                         "OpenGL ES 3.0", "choose a smaller size"};
        width_ = width;
        height_ = height;
        return target_.id();
    }

    Result<Image> read() override {
        Image image{width_, height_, {}};
        std::size_t rowBytes = static_cast<std::size_t>(width_) * 4;
        std::vector<std::uint8_t> bottomUp(rowBytes * static_cast<std::size_t>(height_));
        glBindFramebuffer(GL_FRAMEBUFFER, target_.id());
        glPixelStorei(GL_PACK_ALIGNMENT, 4);
        glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, bottomUp.data());
        STIPPLE_CHECK(gles::checkGl("reading the picture"));
        image.rgba.resize(bottomUp.size());
        for (std::size_t y = 0; y < static_cast<std::size_t>(height_); ++y)
            std::memcpy(image.rgba.data() + y * rowBytes,
                        bottomUp.data() + (static_cast<std::size_t>(height_) - 1 - y) * rowBytes, rowBytes);
        return image;
    }

    std::string driver() const override {
        auto text = [](GLenum name) {
            const GLubyte* value = glGetString(name);
            return std::string(value ? reinterpret_cast<const char*>(value) : "unknown");
        };
        return cat(text(GL_VENDOR), " ", text(GL_RENDERER));
    }

  private:
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
    gles::Framebuffer target_;
    gles::Texture colour_, depth_;
    int width_ = 0, height_ = 0;
};

} // namespace

Result<std::unique_ptr<EglContext>> EglContext::create() {
    std::string answers;
    for (const Named& candidate : candidateDisplays()) {
        auto context = std::make_unique<EglSurfacelessContext>();
        const char* problem = context->open(candidate.display);
        if (!problem)
            return std::unique_ptr<EglContext>(std::move(context));
        answers += cat(answers.empty() ? "" : "; ", candidate.name, ": ", problem);
    }
    return Error{ErrorCode::unsupported, cat("OpenGL ES 3 is not available (", answers, ")"), "EGL",
                 "install a driver such as libegl-mesa0, or use the software backend"};
}

} // namespace stipple::headless
