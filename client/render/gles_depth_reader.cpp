#include "client/render/gles_depth_reader.hpp"

#include "client/render/shader_texts.hpp"

namespace stipple::gles {

Status DepthReader::prepare(int width, int height) {
    if (!program_) {
        STIPPLE_TRY(program, makeProgram("", shader_texts::resolveVertex, shader_texts::stepsFragment));
        program_ = std::move(program);
    }
    if (framebuffer_ && width == width_ && height == height_)
        return {};
    steps_ = Texture();
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, steps_.make());
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.make());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, steps_.id(), 0);
    width_ = width;
    height_ = height;
    return checkGl("making a picture of depths");
}

Result<std::vector<float>> DepthReader::read(const RasterFrame& frame, GLuint depth) {
    STIPPLE_CHECK(prepare(frame.width, frame.height));
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    glViewport(0, 0, frame.width, frame.height);
    glDisable(GL_DEPTH_TEST);
    glUseProgram(program_.id());
    glUniform1i(glGetUniformLocation(program_.id(), "uDepth"), 0);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, depth);
    glBindVertexArray(emptyArray_.make());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glBindTexture(GL_TEXTURE_2D, 0);

    auto width = static_cast<std::size_t>(frame.width), height = static_cast<std::size_t>(frame.height);
    std::vector<std::uint8_t> bottomUp(4 * width * height);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, frame.width, frame.height, GL_RGBA, GL_UNSIGNED_BYTE, bottomUp.data());
    STIPPLE_CHECK(checkGl("reading depths"));
    std::vector<float> distances(width * height);
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const std::uint8_t* p = bottomUp.data() + 4 * ((height - 1 - y) * width + x);
            std::uint32_t step = p[0] | std::uint32_t{p[1]} << 8 | std::uint32_t{p[2]} << 16;
            if (p[3] > 0)
                distances[y * width + x] = distanceOfStep(frame, step);
        }
    return distances;
}

} // namespace stipple::gles
