#include "client/render/gles_targets.hpp"

namespace stipple::gles {

void makeTexture(Texture& texture, GLenum format, int width, int height) {
    texture = Texture();
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, texture.make());
    glTexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

Status PointTarget::resize(int newWidth, int newHeight) {
    if (framebuffer && newWidth == width && newHeight == height)
        return {};
    makeTexture(colour, GL_RGBA8, newWidth, newHeight);
    makeTexture(depth, GL_DEPTH_COMPONENT32F, newWidth, newHeight);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.make());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour.id(), 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth.id(), 0);
    width = newWidth;
    height = newHeight;
    STIPPLE_CHECK(checkGl("making the frame's buffers"));
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        *this = PointTarget();
        return Error{ErrorCode::unsupported, "the driver refuses a framebuffer of RGBA8 and 32-bit depth",
                     "OpenGL ES 3.0", ""};
    }
    return {};
}

} // namespace stipple::gles
