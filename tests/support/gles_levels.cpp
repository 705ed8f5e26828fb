#include "tests/support/gles_levels.hpp"

#include "client/render/gles_nodes.hpp"
#include "client/render/gles_octree.hpp"
#include "client/render/gles_programs.hpp"

#include <cstring>

namespace stipple::test {
namespace {

// The outputs of draw calls while it lives, rasterizing nothing.
class Capture {
  public:
    explicit Capture(std::size_t count) : count_(count) {
        glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, buffer_.make());
        glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, size(), nullptr, GL_STREAM_READ);
        glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer_.id());
        glEnable(GL_RASTERIZER_DISCARD);
        glBeginTransformFeedback(GL_POINTS);
    }
    std::vector<int> read() {
        glEndTransformFeedback();
        glDisable(GL_RASTERIZER_DISCARD);
        std::vector<int> levels(count_, -1);
        const void* mapped = glMapBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, size(), GL_MAP_READ_BIT);
        if (mapped != nullptr)
            std::memcpy(levels.data(), mapped, 4 * count_);
        glUnmapBuffer(GL_TRANSFORM_FEEDBACK_BUFFER);
        glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
        return levels;
    }

  private:
    GLsizeiptr size() const { return static_cast<GLsizeiptr>(4 * count_); }
    gles::Buffer buffer_;
    std::size_t count_;
};

} // namespace

Result<std::vector<std::vector<int>>> glesLevels(const FramePlan& plan, unsigned target) {
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    RasterFrame frame = rasterFrame(plan);
    gles::PointPrograms programs;
    gles::OctreeTexture octree;
    gles::NodeBuffers buffers;
    octree.load(plan);
    std::vector<std::vector<int>> levels;
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
        const DrawNode& node = plan.nodes[i];
        gles::PointVariant variant = gles::PointVariant::of(frame, node);
        variant.captureLevels = true;
        STIPPLE_TRY(program, programs.get(variant));
        program->useFor(frame);
        RasterNode raster = rasterNode(plan, node);
        buffers.bind(node);
        program->setNode(raster);
        program->setOctreePlace(octree.placeOf(i), *node.node);
        Capture capture(node.pointCount);
        glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(node.pointCount));
        levels.push_back(capture.read());
    }
    glBindVertexArray(0);
    STIPPLE_CHECK(gles::checkGl("reading levels back"));
    return levels;
}

} // namespace stipple::test
