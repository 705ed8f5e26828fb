#include "client/render/gles_targets.hpp"

#include <array>
#include <string_view>

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
        return Error{ErrorCode::unsupported,
                     say("the driver refuses a framebuffer of RGBA8 and 32-bit depth"), "OpenGL ES 3.0", ""};
    }
    return {};
}

Status CentreTarget::resize(int newWidth, int newHeight, bool withNormals) {
    if (framebuffer && newWidth == width && newHeight == height && withNormals == normals)
        return {};
    makeTexture(colour, GL_RGBA8, newWidth, newHeight);
    makeTexture(place, withNormals ? GL_RG32UI : GL_R32UI, newWidth, newHeight);
    makeTexture(depth, GL_DEPTH_COMPONENT32F, newWidth, newHeight);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.make());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour.id(), 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, place.id(), 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth.id(), 0);
    const std::array<GLenum, 2> attachments{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(static_cast<GLsizei>(attachments.size()), attachments.data());
    width = newWidth;
    height = newHeight;
    normals = withNormals;
    STIPPLE_CHECK(checkGl("making the buffers of delayed expansion"));
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        *this = CentreTarget();
        return Error{ErrorCode::unsupported,
                     say("the driver refuses a framebuffer of RGBA8, 32-bit integers and 32-bit depth"),
                     "OpenGL ES 3.0", ""};
    }
    return {};
}

// EXT_color_buffer_float makes 16 and 32 bits drawable and 16 blendable, EXT_float_blend 32; natively OpenGL
// ES 3.2 has the former built in. (EXT_color_buffer_half_float: 16 bits alone.)
FloatBlending floatBlending() {
    bool half = false, colourFloat = false, floatBlend = false;
    GLint count = 0, major = 0, minor = 0;
    glGetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLint i = 0; i < count; ++i) {
        const auto* text = reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)));
        std::string_view name = text != nullptr ? text : "";
        name.remove_prefix(name.starts_with("GL_") ? 3 : 0);
        colourFloat |= name == "EXT_color_buffer_float";
        half |= name == "EXT_color_buffer_half_float";
        floatBlend |= name == "EXT_float_blend";
    }
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    glGetIntegerv(GL_MINOR_VERSION, &minor);
    colourFloat |= major * 10 + minor >= 32;
    if (colourFloat && floatBlend)
        return FloatBlending::full;
    return colourFloat || half ? FloatBlending::half : FloatBlending::none;
}

Status SumTarget::resize(int newWidth, int newHeight, FloatBlending wanted) {
    if (framebuffer && newWidth == width && newHeight == height && wanted == kind)
        return {};
    makeTexture(sums, wanted == FloatBlending::full ? GL_RGBA32F : GL_RGBA16F, newWidth, newHeight);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.make());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, sums.id(), 0);
    width = newWidth;
    height = newHeight;
    kind = wanted;
    STIPPLE_CHECK(checkGl("making the buffer of splats"));
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        *this = SumTarget();
        return Error{ErrorCode::unsupported,
                     say("the driver refuses a framebuffer of floating-point colours"), "OpenGL ES 3.0", ""};
    }
    return {};
}

} // namespace stipple::gles
