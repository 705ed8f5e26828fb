#include "client/render/gles_picker.hpp"

#include "client/render/gles_programs.hpp"
#include "client/render/gles_targets.hpp"

#include <array>
#include <cstring>

#ifdef __EMSCRIPTEN__
#include <webgl/webgl2.h>
#endif

namespace stipple::gles {
namespace {

constexpr int side = 2 * maxPickRadius + 1;
// Of the centres of points that reach into it.
constexpr int centreSide = side + 2 * (maxPointPixels / 2 + 2);
constexpr std::size_t wordsPerPixel = 4;

// Copies from the buffer bound for packing; it holds at least `values`.
bool copyPacked(std::vector<GLuint>& values) {
    auto size = static_cast<GLsizeiptr>(values.size() * sizeof(GLuint));
#ifdef __EMSCRIPTEN__
    glGetBufferSubData(GL_PIXEL_PACK_BUFFER, 0, size, values.data());
#else
    const void* mapped = glMapBufferRange(GL_PIXEL_PACK_BUFFER, 0, size, GL_MAP_READ_BIT);
    if (!mapped)
        return false;
    std::memcpy(values.data(), mapped, static_cast<std::size_t>(size));
    glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
#endif
    return true;
}

// Binds and clears a framebuffer of identities for a part of the picture.
void beginWindow(GLuint framebuffer, const PickTarget& target, const PictureWindow& window) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    // The picture's own viewport, moved: pixels have the same centres, so points cover the same ones.
    glViewport(-window.left, -window.bottom, target.frame.width, target.frame.height);
    glDisable(GL_SCISSOR_TEST);
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    const GLuint none[4] = {0, 0, 0, 0};
    const GLfloat farthest = 1;
    glClearBufferuiv(GL_COLOR, 0, none);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
}

} // namespace

Status Picker::prepare() {
    if (framebuffer_)
        return {};
    makeTexture(identities_, GL_RGBA32UI, side, side);
    makeTexture(depth_, GL_DEPTH_COMPONENT32F, side, side);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.make());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, identities_.id(), 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.id(), 0);
    bool complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    Status made = checkGl("making the buffers for picking");
    if (made.ok() && !complete)
        made = Error{ErrorCode::unsupported, say("the driver refuses a framebuffer of four 32-bit integers"),
                     "OpenGL ES 3.0", ""};
    if (!made.ok())
        framebuffer_ = Framebuffer();
    return made;
}

Status Picker::prepareCentres() {
    if (centresFramebuffer_)
        return {};
    makeTexture(centrePoints_, GL_RGBA32UI, centreSide, centreSide);
    makeTexture(centrePlaces_, GL_RG32UI, centreSide, centreSide); // normals, too
    makeTexture(centreDepth_, GL_DEPTH_COMPONENT32F, centreSide, centreSide);
    glBindFramebuffer(GL_FRAMEBUFFER, centresFramebuffer_.make());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, centrePoints_.id(), 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, centrePlaces_.id(), 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, centreDepth_.id(), 0);
    const std::array<GLenum, 2> attachments{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(static_cast<GLsizei>(attachments.size()), attachments.data());
    bool complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    Status made = checkGl("making the buffers for picking");
    if (made.ok() && !complete)
        made = Error{ErrorCode::unsupported,
                     say("the driver refuses a framebuffer of four and two 32-bit integers"), "OpenGL ES 3.0",
                     ""};
    if (!made.ok())
        centresFramebuffer_ = Framebuffer();
    return made;
}

Status Picker::beginCentres(const PickTarget& target) {
    STIPPLE_CHECK(prepareCentres());
    beginWindow(centresFramebuffer_.id(), target, target.centres);
    return {};
}

void Picker::bindCentres(bool bound) const {
    glActiveTexture(GL_TEXTURE0 + centrePointsUnit);
    glBindTexture(GL_TEXTURE_2D, bound ? centrePoints_.id() : 0);
    glActiveTexture(GL_TEXTURE0 + centrePlacesUnit);
    glBindTexture(GL_TEXTURE_2D, bound ? centrePlaces_.id() : 0);
}

Status Picker::begin(const PickTarget& target) {
    fence_.reset();
    STIPPLE_CHECK(prepare());
    beginWindow(framebuffer_.id(), target, target.window);
    return {};
}

void Picker::finish(PickTarget target) {
    target_ = std::move(target);
    pixels_ = Buffer(); // browsers frown on one that is written again before it was read
    glBindBuffer(GL_PIXEL_PACK_BUFFER, pixels_.make());
    glBufferData(GL_PIXEL_PACK_BUFFER, side * side * wordsPerPixel * sizeof(GLuint), nullptr, GL_STREAM_READ);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    if (!target_.window.empty())
        glReadPixels(0, 0, target_.window.width, target_.window.height, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                     nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    fence_.reset(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
    glFlush();
}

Result<std::optional<PickAnswer>> Picker::take() {
    if (!fence_)
        return std::optional<PickAnswer>();
    GLenum state = glClientWaitSync(fence_.get(), 0, 0);
    if (state == GL_TIMEOUT_EXPIRED)
        return std::optional<PickAnswer>();
    fence_.reset();
    if (state == GL_WAIT_FAILED)
        return Error{ErrorCode::ioFailed, say("the driver lost what it was asked about the pointer"),
                     "OpenGL ES 3.0", ""};
    std::vector<PickSample> samples = readSamples();
    STIPPLE_CHECK(checkGl("reading what is near the pointer"));
    return std::optional(PickAnswer{nearestHit(target_, samples)});
}

std::vector<PickSample> Picker::readSamples() const {
    const PictureWindow& window = target_.window;
    std::vector<PickSample> samples;
    if (window.empty())
        return samples;
    auto width = static_cast<std::size_t>(window.width), height = static_cast<std::size_t>(window.height);
    std::vector<GLuint> values(width * height * wordsPerPixel);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, pixels_.id());
    bool copied = copyPacked(values);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    for (std::size_t i = 0; copied && i < width * height; ++i) {
        const GLuint* pixel = values.data() + i * wordsPerPixel;
        if (pixel[3] == 1 && pixel[0] < target_.nodes.size())
            samples.push_back({window.left + static_cast<int>(i % width),
                               window.bottom + static_cast<int>(i / width), pixel[2], pixel[0], pixel[1]});
    }
    return samples;
}

} // namespace stipple::gles
