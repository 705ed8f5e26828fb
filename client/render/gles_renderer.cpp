#include "client/render/gles_renderer.hpp"

#include "client/render/gles_depth_reader.hpp"
#include "client/render/gles_nodes.hpp"
#include "client/render/gles_objects.hpp"
#include "client/render/gradients.hpp"
#include "client/render/raster_setup.hpp"
#include "client/render/shader_texts.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace stipple {
namespace {

using namespace gles;

constexpr float levelsInv = 1.0f / 255.0f;

// points.vert.glsl + points.frag.glsl with one set of defines, and where its uniforms are.
struct PointProgram {
    Program program;
    GLint cell, fraction, rowX, rowY, rowD, positionShift, colourSource, ramp;
    GLint deep, fractionBits, lowX, highX, lowY, highY, origin;
    GLint centre, nearFar, nearBits, depthShift, perspective, sizeByDistance, size64, worldSize64,
        sizeRange64, gradient;
    GLint rank, continuous, growth, falloff, leastDensity, sizeByDensity;

    static Result<PointProgram> make(bool lowWords, bool circle) {
        std::string defines = cat("#define GRADIENT_ENTRIES ", gradientEntries, "\n");
        defines += lowWords ? "#define LOW_WORDS\n" : "";
        defines += circle ? "#define CIRCLE\n" : "";
        STIPPLE_TRY(program, makeProgram(defines, shader_texts::pointsVertex, shader_texts::pointsFragment));
        PointProgram made;
        auto at = [&](const char* name) { return glGetUniformLocation(program.id(), name); };
        made.cell = at("uCell");
        made.fraction = at("uFraction");
        made.rowX = at("uRowX");
        made.rowY = at("uRowY");
        made.rowD = at("uRowD");
        made.positionShift = at("uPositionShift");
        made.deep = at("uDeep");
        made.fractionBits = at("uFractionBits");
        made.lowX = at("uLowX");
        made.highX = at("uHighX");
        made.lowY = at("uLowY");
        made.highY = at("uHighY");
        made.origin = at("uOrigin");
        made.colourSource = at("uColourSource");
        made.ramp = at("uRamp");
        made.centre = at("uCentre");
        made.nearFar = at("uNearFar");
        made.nearBits = at("uNearBits");
        made.depthShift = at("uDepthShift");
        made.perspective = at("uPerspective");
        made.sizeByDistance = at("uSizeByDistance");
        made.size64 = at("uSize64");
        made.worldSize64 = at("uWorldSize64");
        made.sizeRange64 = at("uSizeRange64");
        made.gradient = at("uGradient");
        made.rank = at("uRank");
        made.continuous = at("uContinuous");
        made.growth = at("uGrowth");
        made.falloff = at("uFalloff");
        made.leastDensity = at("uLeastDensity");
        made.sizeByDensity = at("uSizeByDensity");
        made.program = std::move(program);
        return made;
    }

    void useFor(const RasterFrame& frame) const {
        glUseProgram(program.id());
        glUniform2f(centre, frame.centreX, frame.centreY);
        glUniform2f(nearFar, frame.near, frame.far);
        glUniform1ui(nearBits, frame.nearBits);
        glUniform1i(depthShift, frame.depthShift);
        glUniform1i(perspective, frame.perspective);
        glUniform1i(sizeByDistance, frame.sizeByDistance);
        glUniform1f(size64, static_cast<float>(frame.size64));
        glUniform1f(worldSize64, frame.worldSize64);
        glUniform2f(sizeRange64, static_cast<float>(frame.minSize64), static_cast<float>(frame.maxSize64));
        glUniform1i(gradient, 0);
        glUniform1i(continuous, frame.continuous);
        glUniform1f(growth, frame.growth);
        glUniform2f(falloff, frame.falloffX, frame.falloffY);
        glUniform1f(leastDensity, frame.leastDensity);
        glUniform1i(sizeByDensity, frame.sizeByDensity);
    }

    void setNode(const RasterNode& node) const {
        glUniform3iv(cell, 1, node.cell.data());
        glUniform3fv(fraction, 1, node.fraction.data());
        glUniform3fv(rowX, 1, node.rowX.data());
        glUniform3fv(rowY, 1, node.rowY.data());
        glUniform3fv(rowD, 1, node.rowD.data());
        glUniform1i(positionShift, node.positionShift);
        glUniform1i(deep, node.deep);
        if (node.deep) {
            glUniform1i(fractionBits, node.fractionBits);
            glUniform3uiv(lowX, 1, node.lowX.data());
            glUniform3uiv(highX, 1, node.highX.data());
            glUniform3uiv(lowY, 1, node.lowY.data());
            glUniform3uiv(highY, 1, node.highY.data());
            glUniform2ui(origin, node.originX, node.originY);
        }
        glUniform1i(colourSource, static_cast<GLint>(node.source));
        glUniform2f(ramp, node.rampScale, node.rampOffset);
        glUniform2f(rank, node.rankBase, node.rankStep);
    }
};

struct ResolveProgram {
    Program program;
    GLint colour, depth, nearBits, depthShift, neighbours, offsets, power;

    static Result<ResolveProgram> make() {
        STIPPLE_TRY(program, makeProgram("", shader_texts::resolveVertex, shader_texts::resolveFragment));
        ResolveProgram made;
        auto at = [&](const char* name) { return glGetUniformLocation(program.id(), name); };
        made.colour = at("uColour");
        made.depth = at("uDepth");
        made.nearBits = at("uNearBits");
        made.depthShift = at("uDepthShift");
        made.neighbours = at("uNeighbours");
        made.offsets = at("uOffsets");
        made.power = at("uPower");
        made.program = std::move(program);
        return made;
    }

    void useFor(const RasterFrame& frame, const EdlSetup& edl) const {
        glUseProgram(program.id());
        glUniform1i(colour, 0);
        glUniform1i(depth, 1);
        glUniform1ui(nearBits, frame.nearBits);
        glUniform1i(depthShift, frame.depthShift);
        glUniform1i(neighbours, edl.enabled ? edl.neighbours : 0);
        if (edl.enabled)
            glUniform2iv(offsets, edl.neighbours, edl.offsets[0].data());
        glUniform1f(power, edl.power);
    }
};

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

// Colour and depth of the points before the resolve pass. Both are core in OpenGL ES 3.0: RGBA8, and 32-bit
// float depth that shaders can read, whose steps q / 2^24 are exact.
struct PointTarget {
    Framebuffer framebuffer;
    Texture colour, depth;
    int width = 0, height = 0;

    std::uint64_t bytes() const {
        return 8ull * static_cast<unsigned>(width) * static_cast<unsigned>(height);
    }

    Status resize(int newWidth, int newHeight) {
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
};

// Whether points can go straight to the framebuffer that is bound: one sample a pixel, 24 bits of depth.
bool takesPointsDirectly(unsigned target) {
    GLint samples = 0;
    glGetIntegerv(GL_SAMPLES, &samples);
    if (samples > 0)
        return false;
    GLenum attachment = target == 0 ? GLenum{GL_DEPTH} : GLenum{GL_DEPTH_ATTACHMENT};
    GLint kind = GL_NONE, bits = 0;
    glGetFramebufferAttachmentParameteriv(GL_FRAMEBUFFER, attachment, GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE,
                                          &kind);
    if (kind != GL_NONE)
        glGetFramebufferAttachmentParameteriv(GL_FRAMEBUFFER, attachment,
                                              GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE, &bits);
    return bits >= depthBits;
}

class Gles3Renderer final : public GlesRenderer {
  public:
    Status init() {
        for (std::size_t i = 0; i < pointPrograms_.size(); ++i) {
            STIPPLE_TRY(program, PointProgram::make((i & 1) != 0, (i & 2) != 0));
            pointPrograms_[i] = std::move(program);
        }
        STIPPLE_TRY(resolve, ResolveProgram::make());
        resolve_ = std::move(resolve);
        makeTexture(gradient_, GL_RGBA8, gradientEntries, 1);
        emptyArray_.make();
        return checkGl("preparing to draw");
    }

    Status draw(FramePlan& plan, unsigned target) override {
        STIPPLE_CHECK(checkSize(plan));
        RasterFrame frame = rasterFrame(plan);
        EdlSetup edl = edlSetup(plan.style.edl);
        bool direct = !edl.enabled && directTo(target);
        if (!direct)
            STIPPLE_CHECK(points_.resize(plan.width, plan.height));

        glBindFramebuffer(GL_FRAMEBUFFER, direct ? target : points_.framebuffer.id());
        drawPoints(plan, frame);
        plan.counters.passesRun += 1;
        if (!direct) {
            glBindFramebuffer(GL_FRAMEBUFFER, target);
            resolve(frame, edl);
            plan.counters.passesRun += 1;
        }
        plan.counters.passesSkipped += edl.enabled ? 0 : 1;
        glBindVertexArray(0);
        // Asking for errors waits for the GPU in browsers, so only frames that could run out of memory do.
        return nodes_.endFrame() ? checkGl("uploading points") : Status();
    }

    Result<std::vector<float>> distances(const FramePlan& plan) override {
        STIPPLE_CHECK(checkSize(plan));
        RasterFrame frame = rasterFrame(plan);
        STIPPLE_CHECK(points_.resize(plan.width, plan.height));
        glBindFramebuffer(GL_FRAMEBUFFER, points_.framebuffer.id());
        drawPoints(plan, frame);
        nodes_.endFrame();
        return depthReader_.read(frame, points_.depth.id());
    }

    std::uint64_t gpuBytes() const override {
        return nodes_.bytes() + points_.bytes() + 4ull * gradientEntries;
    }

  private:
    static Status checkSize(const FramePlan& plan) {
        if (plan.width < 1 || plan.height < 1 || plan.width > maxPictureSide || plan.height > maxPictureSide)
            return Error{ErrorCode::invalidArgument,
                         cat("a picture of ", plan.width, " × ", plan.height, " pixels can't be drawn"), "",
                         cat("each side must be in 1..", maxPictureSide)};
        return {};
    }

    // The default framebuffer never changes its kind, so it is asked once.
    bool directTo(unsigned target) {
        if (target == 0 && defaultIsDirect_)
            return *defaultIsDirect_;
        glBindFramebuffer(GL_FRAMEBUFFER, target);
        bool direct = takesPointsDirectly(target);
        if (target == 0)
            defaultIsDirect_ = direct;
        return direct;
    }

    void loadGradient(GradientName name) {
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_2D, gradient_.id());
        if (loadedGradient_ == name)
            return;
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, gradientEntries, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                        gradientTable(name).data());
        loadedGradient_ = name;
    }

    void drawPoints(const FramePlan& plan, const RasterFrame& frame) {
        const auto& background = plan.style.background;
        glViewport(0, 0, plan.width, plan.height);
        glDisable(GL_SCISSOR_TEST);
        glDisable(GL_BLEND);
        glDisable(GL_CULL_FACE);
        glDisable(GL_DITHER);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        glDepthMask(GL_TRUE);
        glDepthRangef(0, 1);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glClearColor(background[0] * levelsInv, background[1] * levelsInv, background[2] * levelsInv, 1);
        glClearDepthf(1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        loadGradient(plan.style.gradient);
        glVertexAttrib4f(colourLocation, (plainColourWord & 255) * levelsInv,
                         (plainColourWord >> 8 & 255) * levelsInv, (plainColourWord >> 16 & 255) * levelsInv,
                         1);
        glVertexAttrib1f(intensityLocation, 0);

        const PointProgram* inUse = nullptr;
        for (std::size_t index : drawOrder(plan)) {
            const DrawNode& node = plan.nodes[index];
            const PointProgram& program = programFor(*node.node, frame);
            if (&program != inUse)
                program.useFor(frame);
            inUse = &program;
            RasterNode raster = rasterNode(plan, node);
            nodes_.bind(*node.node, raster.source);
            program.setNode(raster);
            glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(node.pointCount));
        }
    }

    const PointProgram& programFor(const ResidentNode& node, const RasterFrame& frame) const {
        return pointPrograms_[(node.positionShift > 0 ? 1u : 0u) | (frame.circle ? 2u : 0u)];
    }

    void resolve(const RasterFrame& frame, const EdlSetup& edl) {
        glViewport(0, 0, frame.width, frame.height);
        glDisable(GL_DEPTH_TEST);
        resolve_.useFor(frame, edl);
        glActiveTexture(GL_TEXTURE1);
        glBindTexture(GL_TEXTURE_2D, points_.depth.id());
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_2D, points_.colour.id());
        glBindVertexArray(emptyArray_.id());
        glDrawArrays(GL_TRIANGLES, 0, 3);
        // A texture may not stay readable while the next frame draws into it.
        glBindTexture(GL_TEXTURE_2D, 0);
        glActiveTexture(GL_TEXTURE1);
        glBindTexture(GL_TEXTURE_2D, 0);
    }

    std::array<PointProgram, 4> pointPrograms_; // bit 0: low words, bit 1: circles
    ResolveProgram resolve_;
    Texture gradient_;
    std::optional<GradientName> loadedGradient_;
    VertexArray emptyArray_;
    PointTarget points_;
    NodeBuffers nodes_;
    DepthReader depthReader_;
    std::optional<bool> defaultIsDirect_;
};

} // namespace

Result<std::unique_ptr<GlesRenderer>> GlesRenderer::create() {
    auto renderer = std::make_unique<Gles3Renderer>();
    STIPPLE_CHECK(renderer->init());
    return std::unique_ptr<GlesRenderer>(std::move(renderer));
}

} // namespace stipple
