#include "client/headless/frame_drawer.hpp"

#include "client/headless/egl_context.hpp"
#include "client/render/gles_renderer.hpp"
#include "client/render/raster_setup.hpp"
#include "client/render/software_renderer.hpp"

namespace stipple::headless {
namespace {

class SoftwareDrawer final : public FrameDrawer {
  public:
    explicit SoftwareDrawer(int threads) : renderer_(SoftwareRenderer::create(threads)) {}

    Result<const Image*> draw(FramePlan& plan) override { return &renderer_->render(plan); }
    Result<std::vector<float>> distances(const FramePlan&) override { return renderer_->distances(); }
    std::string name() const override { return "software"; }

  private:
    std::unique_ptr<SoftwareRenderer> renderer_;
};

class GlesDrawer final : public FrameDrawer {
  public:
    Status init() {
        STIPPLE_TRY(context, EglContext::create());
        context_ = std::move(context);
        STIPPLE_TRY(renderer, GlesRenderer::create());
        renderer_ = std::move(renderer);
        return {};
    }

    Result<const Image*> draw(FramePlan& plan) override {
        PictureWindow drawn = drawnWindow(plan);
        STIPPLE_TRY(target, context_->framebuffer(drawn.width, drawn.height));
        STIPPLE_CHECK(renderer_->draw(plan, target));
        STIPPLE_TRY(image, context_->read());
        image_ = std::move(image);
        return &image_;
    }
    Result<std::vector<float>> distances(const FramePlan& plan) override {
        return renderer_->distances(plan);
    }
    std::string name() const override { return context_->driver(); }
    std::string limitation() const override { return renderer_->limitation(); }

  private:
    std::unique_ptr<EglContext> context_;
    std::unique_ptr<GlesRenderer> renderer_; // frees its objects while the context is there
    Image image_;
};

} // namespace

Result<std::unique_ptr<FrameDrawer>> FrameDrawer::create(Backend backend, int threads) {
    if (backend == Backend::software)
        return std::unique_ptr<FrameDrawer>(std::make_unique<SoftwareDrawer>(threads));
    auto drawer = std::make_unique<GlesDrawer>();
    STIPPLE_CHECK(drawer->init());
    return std::unique_ptr<FrameDrawer>(std::move(drawer));
}

} // namespace stipple::headless
