#include "tests/bench/adaptive_drawer.hpp"

#include <algorithm>

namespace stipple {
namespace {

constexpr float levelsInv = 1.0f / 255.0f;

void begin(const FramePlan& plan, unsigned target) {
    const auto& background = plan.style.background;
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glViewport(0, 0, plan.width, plan.height);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_DITHER);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glClearColor(background[0] * levelsInv, background[1] * levelsInv, background[2] * levelsInv, 1);
    glClearDepthf(1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glVertexAttrib4f(gles::colourLocation, (plainColourWord & 255) * levelsInv,
                     (plainColourWord >> 8 & 255) * levelsInv, (plainColourWord >> 16 & 255) * levelsInv, 1);
}

// One size in a node, as sizes from the octree come out for points of its own level (raster_setup.hpp,
// "Adaptive").
void setNodeSize(const gles::PointProgram& program, const RasterFrame& frame, const RasterNode& node) {
    if (frame.perspective)
        glUniform1f(program.worldSize64, node.nodeSize64);
    else
        glUniform1f(program.size64, std::clamp(node.nodeSize64 + 0.5f, static_cast<float>(frame.minSize64),
                                               static_cast<float>(frame.maxSize64)));
}

} // namespace

Status AdaptiveDrawer::drawByOctree(const FramePlan& plan, unsigned target) {
    begin(plan, target);
    RasterFrame frame = rasterFrame(plan);
    octree_.load(plan);
    const gles::PointProgram* inUse = nullptr;
    for (std::size_t index : drawOrder(plan)) {
        const DrawNode& node = plan.nodes[index];
        STIPPLE_TRY(program, programs_.get(gles::PointVariant::of(frame, node)));
        if (program != inUse)
            program->useFor(frame);
        inUse = program;
        nodes_.bind(node);
        program->setNode(rasterNode(plan, node));
        program->setOctreePlace(octree_.placeOf(index), *node.node);
        glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(node.pointCount));
    }
    glBindVertexArray(0);
    nodes_.endFrame(plan.gpuBytes);
    return gles::checkGl("drawing by the octree texture");
}

Status AdaptiveDrawer::drawBatches(const PointBatches& batches, unsigned target) {
    const FramePlan& plan = batches.plan();
    begin(plan, target);
    RasterFrame frame = rasterFrame(plan);
    frame.adaptive = false;
    frame.sizeByDistance = frame.perspective;
    const gles::PointProgram* inUse = nullptr;
    for (std::size_t index : drawOrder(plan)) {
        const DrawNode& node = plan.nodes[index];
        STIPPLE_TRY(program, programs_.get(gles::PointVariant::of(frame, node)));
        if (program != inUse)
            program->useFor(frame);
        inUse = program;
        nodes_.bind(node);
        RasterNode raster = rasterNode(plan, node);
        program->setNode(raster);
        setNodeSize(*program, frame, raster);
        for (const BatchRun& run : batches.runs(index))
            glDrawArrays(GL_POINTS, static_cast<GLint>(run.first), static_cast<GLsizei>(run.count));
    }
    glBindVertexArray(0);
    nodes_.endFrame(plan.gpuBytes);
    return gles::checkGl("drawing batches");
}

} // namespace stipple
