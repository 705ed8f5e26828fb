#include "client/render/gles_renderer.hpp"

#include "client/render/gles_depth_reader.hpp"
#include "client/render/gles_nodes.hpp"
#include "client/render/gles_objects.hpp"
#include "client/render/gles_octree.hpp"
#include "client/render/gles_picker.hpp"
#include "client/render/gles_programs.hpp"
#include "client/render/gles_targets.hpp"
#include "client/render/picture_parts.hpp"
#include "client/render/raster_setup.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <optional>
#include <string>

namespace stipple {
namespace {

using namespace gles;

Phrase withoutFloats() {
    return say("this graphics driver can't blend into floating-point colours (EXT_color_buffer_float): "
               "points are drawn "
               "without high-quality splats");
}

// Diameter of the largest point that the driver draws, pixels (OpenGL ES 3.0 §2.8: at least 1).
int largestPoint() {
    GLfloat range[2] = {1, 1};
    glGetFloatv(GL_ALIASED_POINT_SIZE_RANGE, range);
    return static_cast<int>(range[1]);
}
int largestSide() {
    GLint texture = 0, viewport[2] = {0, 0};
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    return std::min({maxPartSide, texture, viewport[0], viewport[1]});
}

constexpr ExpansionCosts expansionCosts{3, 1};

constexpr float levelsInv = 1.0f / 255.0f;

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
    Status init(FloatBlending most, int mostPointPixels) {
        floatBlending_ = std::min(most, floatBlending());
        pointPixels_ = std::min(mostPointPixels, largestPoint());
        partSide_ = largestSide();
        // Most pictures need these, so they are compiled while points are still on their way. Nothing here
        // waits for the GPU: what does not compile is told by draw().
        for (bool growing : {true, false})
            pointPrograms_.start({.circle = true, .growing = growing});
        startedResolve_ = ResolveProgram::start(false);
        emptyArray_.make();
        return {};
    }

    Status draw(FramePlan& plan, unsigned target) override {
        STIPPLE_CHECK(checkSize(plan));
        RasterFrame frame = rasterFrame(plan);
        EdlSetup edl = edlSetup(plan.style.edl);
        order_ = partOrder(plan, frame);
        countOutside(plan, order_);
        bool blends = frame.splats && floatBlending_ != FloatBlending::none;
        limitation_ = limitationOf(frame, blends);
        if (plan.nodes.empty())
            return drawNothing(plan, target);
        bool direct = !edl.enabled && !blends && directTo(target);
        if (!direct)
            STIPPLE_CHECK(points_.resize(frame.width, frame.height));

        bool late = expandsLate(plan, frame, expansionCosts);
        STIPPLE_CHECK(drawPoints(plan, frame, late, direct ? target : points_.framebuffer.id()));
        plan.counters.passesRun += late ? 2 : 1;
        if (blends) {
            STIPPLE_CHECK(blend(plan, frame, late));
            plan.counters.passesRun += 1;
        } else {
            sums_ = SumTarget();
        }
        if (!direct) {
            glBindFramebuffer(GL_FRAMEBUFFER, target);
            STIPPLE_CHECK(resolve(plan, frame, edl, blends));
            plan.counters.passesRun += 1;
        }
        plan.counters.passesSkipped += edl.enabled ? 0 : 1;
        glBindVertexArray(0);
        // Asking for errors waits for the GPU in browsers, so only frames that could run out of memory do.
        return nodes_.endFrame(plan.gpuBytes) ? checkGl("uploading points") : Status();
    }

    Result<std::vector<float>> distances(const FramePlan& plan) override {
        STIPPLE_CHECK(checkSize(plan));
        RasterFrame frame = rasterFrame(plan);
        STIPPLE_CHECK(points_.resize(frame.width, frame.height));
        order_ = partOrder(plan, frame);
        bool late = expandsLate(plan, frame, expansionCosts);
        STIPPLE_CHECK(drawPoints(plan, frame, late, points_.framebuffer.id()));
        nodes_.endFrame(plan.gpuBytes);
        return depthReader_.read(frame, points_.depth.id());
    }

    Status startPick(const FramePlan& plan, const PickRequest& request) override {
        STIPPLE_CHECK(checkSize(plan));
        PickTarget target = pickTarget(plan, request);
        bool late = !target.window.empty() && expandsLate(plan, target.frame, expansionCosts);
        if (late) {
            STIPPLE_CHECK(picker_.beginCentres(target));
            setPointState();
            STIPPLE_CHECK(drawNodes(plan, target.frame, target.order,
                                    {.collects = true, .identities = &target.centres}));
        }
        STIPPLE_CHECK(picker_.begin(target));
        setPointState();
        STIPPLE_CHECK(late ? drawExpandedIdentities(target)
                           : drawNodes(plan, target.frame, target.order, {.identities = &target.window}));
        glBindVertexArray(0);
        picker_.finish(std::move(target));
        return {};
    }
    Result<std::optional<PickAnswer>> takePick() override { return picker_.take(); }
    bool pickPending() const override { return picker_.pending(); }

    std::uint64_t gpuBytes() const override {
        return nodes_.bytes() + points_.bytes() + centres_.bytes() + sums_.bytes() + octree_.bytes();
    }

    const Phrase& limitation() const override { return limitation_; }

  private:
    // The background alone.
    Status drawNothing(FramePlan& plan, GLuint target) {
        glBindFramebuffer(GL_FRAMEBUFFER, target);
        clear(plan);
        plan.counters.passesSkipped += 2; // points, and what makes a picture of them
        return nodes_.endFrame(plan.gpuBytes) ? checkGl("drawing nothing") : Status();
    }

    Status checkSize(const FramePlan& plan) const {
        PictureWindow drawn = drawnWindow(plan);
        if (!isDrawable(plan, partSide_))
            return Error{ErrorCode::invalidArgument,
                         say("a picture of ", drawn.width, " × ", drawn.height, " pixels can't be drawn"), "",
                         say("each side must be in 1..", partSide_, " with this graphics driver")};
        return {};
    }

    Phrase limitationOf(const RasterFrame& frame, bool blends) const {
        Phrase told = frame.splats && !blends ? withoutFloats() : Phrase();
        int largest = ((sizesDiffer(frame) ? frame.maxSize64 : frame.size64) + sizeSteps - 1) / sizeSteps;
        if (frame.disc && frame.perspective) // what leans towards the eye is seen larger
            largest = maxPointPixels;
        if (largest <= pointPixels_)
            return told;
        Phrase cut = say("this graphics driver draws points of at most ", pointPixels_,
                         " pixels: larger ones are cut down to that");
        return told.empty() ? cut : say(told, "; ", cut);
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

    // The nearest points, in their sizes, into `target`.
    Status drawPoints(const FramePlan& plan, const RasterFrame& frame, bool late, GLuint target) {
        if (!late) {
            centres_ = CentreTarget();
            glBindFramebuffer(GL_FRAMEBUFFER, target);
            clear(plan);
            return drawNodes(plan, frame, order_, {});
        }
        STIPPLE_CHECK(centres_.resize(frame.width, frame.height, frame.disc));
        glBindFramebuffer(GL_FRAMEBUFFER, centres_.framebuffer.id());
        clearCentres(plan);
        STIPPLE_CHECK(drawNodes(plan, frame, order_, {.collects = true}));
        glBindFramebuffer(GL_FRAMEBUFFER, target);
        clear(plan);
        return drawExpanded(frame, {});
    }

    static void setViewport(const FramePlan& plan) {
        PictureWindow drawn = drawnWindow(plan);
        glViewport(0, 0, drawn.width, drawn.height);
    }

    void clear(const FramePlan& plan) {
        const auto& background = plan.style.background;
        setViewport(plan);
        setPointState();
        glClearColor(background[0] * levelsInv, background[1] * levelsInv, background[2] * levelsInv, 1);
        glClearDepthf(1);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    }

    // Buffer by buffer: glClear can't clear integers beside colours, and browsers then clear nothing.
    void clearCentres(const FramePlan& plan) {
        setViewport(plan);
        setPointState();
        const GLfloat black[4] = {0, 0, 0, 1}, farthest = 1;
        const GLuint nothing[4] = {0, 0, 0, 0};
        glClearBufferfv(GL_COLOR, 0, black);
        glClearBufferuiv(GL_COLOR, 1, nothing);
        glClearBufferfv(GL_DEPTH, 0, &farthest);
    }

    static void setPointState() {
        glDisable(GL_SCISSOR_TEST);
        glDisable(GL_BLEND);
        glDisable(GL_CULL_FACE);
        glDisable(GL_DITHER);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        glDepthMask(GL_TRUE);
        glDepthRangef(0, 1);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    }

    // One vertex for each pixel, most often a point: what drawPoints() collected.
    Status drawExpanded(const RasterFrame& frame, PointVariant variant) {
        variant.disc = frame.disc; // points without normals have a word that says so
        variant.circle = frame.circle && !frame.disc;
        variant.paraboloid = frame.paraboloid;
        variant.expand = true;
        STIPPLE_TRY(program, pointPrograms_.get(variant));
        program->useFor(frame);
        auto bind = [](int unit, GLuint texture) {
            glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
            glBindTexture(GL_TEXTURE_2D, texture);
        };
        bind(centreColoursUnit, centres_.colour.id());
        bind(centreDepthsUnit, centres_.depth.id());
        bind(centrePlacesUnit, centres_.place.id());
        glBindVertexArray(emptyArray_.id());
        glDrawArrays(GL_POINTS, 0, frame.width * frame.height);
        for (int unit : {centreColoursUnit, centreDepthsUnit, centrePlacesUnit})
            bind(unit, 0);
        return {};
    }

    // The same where identities are written; one vertex for each pixel of the centres' window.
    Status drawExpandedIdentities(const PickTarget& target) {
        PointVariant variant{.circle = target.frame.circle && !target.frame.disc,
                             .paraboloid = target.frame.paraboloid,
                             .disc = target.frame.disc};
        variant.expand = variant.identity = true;
        STIPPLE_TRY(program, pointPrograms_.get(variant));
        program->useFor(target.frame);
        program->setIdentityWindows(target.centres, target.window);
        picker_.bindCentres(true);
        glBindVertexArray(emptyArray_.id());
        glDrawArrays(GL_POINTS, 0, target.centres.width * target.centres.height);
        picker_.bindCentres(false);
        return {};
    }

    // The second pass of splats, over the depths of the first.
    Status blend(const FramePlan& plan, const RasterFrame& frame, bool late) {
        STIPPLE_CHECK(sums_.resize(frame.width, frame.height, floatBlending_));
        glBindFramebuffer(GL_FRAMEBUFFER, sums_.framebuffer.id());
        glClearColor(0, 0, 0, 0);
        glClear(GL_COLOR_BUFFER_BIT);
        glDisable(GL_DEPTH_TEST);
        glEnable(GL_BLEND);
        glBlendEquation(GL_FUNC_ADD);
        glBlendFunc(GL_ONE, GL_ONE);
        glActiveTexture(GL_TEXTURE0 + nearestUnit);
        glBindTexture(GL_TEXTURE_2D, points_.depth.id());
        Status drawn =
            late ? drawExpanded(frame, {.blend = true}) : drawNodes(plan, frame, order_, {.blends = true});
        glActiveTexture(GL_TEXTURE0 + nearestUnit);
        glBindTexture(GL_TEXTURE_2D, 0);
        glDisable(GL_BLEND);
        return drawn;
    }

    // What points write: their colour; weighted colours, for a sum; or, in a window of the picture, which
    // they are, by their node's place in the order.
    struct Drawing {
        bool blends = false;
        bool collects = false; // the first pass of delayed expansion
        const PictureWindow* identities = nullptr;
    };

    // The points of those nodes, into what is bound.
    Status drawNodes(const FramePlan& plan, const RasterFrame& frame, const std::vector<std::size_t>& order,
                     const Drawing& how) {
        if (walksOctree(frame))
            octree_.load(plan);
        else
            octree_.clear();
        glVertexAttrib4f(colourLocation, (plainColourWord & 255) * levelsInv,
                         (plainColourWord >> 8 & 255) * levelsInv, (plainColourWord >> 16 & 255) * levelsInv,
                         1);

        const PointProgram* inUse = nullptr;
        for (std::size_t place = 0; place < order.size(); ++place) {
            const std::size_t index = order[place];
            const DrawNode& node = plan.nodes[index];
            PointVariant variant = PointVariant::of(frame, node);
            variant.blend = how.blends;
            variant.identity = how.identities != nullptr;
            variant.collect = how.collects;
            variant.circle = variant.circle && !how.collects;
            variant.paraboloid = variant.paraboloid && !how.collects;
            variant.disc = variant.disc && !how.collects;
            STIPPLE_TRY(program, pointPrograms_.get(variant));
            if (program != inUse)
                program->useFor(frame);
            inUse = program;
            RasterNode raster = rasterNode(plan, node);
            nodes_.bind(node);
            program->setNode(raster);
            if (how.identities)
                program->setIdentity(static_cast<std::uint32_t>(place), how.identities->left,
                                     how.identities->bottom);
            if (walksOctree(frame))
                program->setOctreePlace(octree_.placeOf(index), *node.node);
            glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(node.pointCount));
        }
        return {};
    }

    Result<const ResolveProgram*> resolveProgram(bool sums) {
        std::optional<ResolveProgram>& made = sums ? resolveSums_ : resolve_;
        if (!made) {
            STIPPLE_TRY(program,
                        ResolveProgram::finish(sums || !startedResolve_ ? ResolveProgram::start(sums)
                                                                        : std::move(startedResolve_)));
            made = std::move(program);
        }
        return &*made;
    }

    Status resolve(const FramePlan& plan, const RasterFrame& frame, const EdlSetup& edl, bool blends) {
        STIPPLE_TRY(program, resolveProgram(blends));
        glViewport(0, 0, frame.width, frame.height);
        glDisable(GL_DEPTH_TEST);
        program->useFor(frame, edl, plan.style.background);
        glActiveTexture(GL_TEXTURE1);
        glBindTexture(GL_TEXTURE_2D, points_.depth.id());
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_2D, blends ? sums_.sums.id() : points_.colour.id());
        glBindVertexArray(emptyArray_.id());
        glDrawArrays(GL_TRIANGLES, 0, 3);
        // A texture may not stay readable while the next frame draws into it.
        glBindTexture(GL_TEXTURE_2D, 0);
        glActiveTexture(GL_TEXTURE1);
        glBindTexture(GL_TEXTURE_2D, 0);
        return {};
    }

    std::vector<std::size_t> order_; // of the nodes of the plan that is drawn
    PointPrograms pointPrograms_;
    OctreeTexture octree_;
    Program startedResolve_;
    std::optional<ResolveProgram> resolve_, resolveSums_;
    VertexArray emptyArray_;
    PointTarget points_;
    CentreTarget centres_; // delayed expansion
    SumTarget sums_;       // splats
    FloatBlending floatBlending_ = FloatBlending::none;
    int pointPixels_ = maxPointPixels, partSide_ = maxPartSide;
    Phrase limitation_;
    NodeBuffers nodes_;
    DepthReader depthReader_;
    Picker picker_;
    std::optional<bool> defaultIsDirect_;
};

} // namespace

Result<std::unique_ptr<GlesRenderer>> GlesRenderer::create(gles::FloatBlending mostBlending,
                                                           int mostPointPixels) {
    auto renderer = std::make_unique<Gles3Renderer>();
    STIPPLE_CHECK(renderer->init(mostBlending, mostPointPixels));
    return std::unique_ptr<GlesRenderer>(std::move(renderer));
}

} // namespace stipple
