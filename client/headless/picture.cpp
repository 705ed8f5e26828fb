#include "client/headless/picture.hpp"

#include "client/core/json.hpp"
#include "client/headless/egl_context.hpp"
#include "client/headless/thread_decoder.hpp"
#include "client/render/gles_renderer.hpp"
#include "client/render/raster_setup.hpp"
#include "client/render/software_renderer.hpp"
#include "shared/base/text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace stipple::headless {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds updateWait{100};

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

Result<Camera> cameraOf(const PictureRequest& request, const BoxD& content) {
    double aspect = static_cast<double>(request.width) / request.height;
    Projection projection = request.projection.value_or(Projection::perspective);
    if (auto named = namedViewFromName(request.view))
        return namedCamera(*named, content, aspect, projection);
    if (request.view.find('{') == std::string::npos)
        return Error{ErrorCode::invalidArgument, cat("there is no view '", request.view, "'"), "--view",
                     "choose top, front or iso, or give a camera as JSON"};
    STIPPLE_TRY(json, parseJson(request.view, "--view"));
    STIPPLE_TRY(camera, cameraFromJson(json, namedCamera(NamedView::iso, content, aspect, projection)));
    if (request.projection)
        camera.projection = *request.projection;
    if (!isUsable(camera))
        return Error{ErrorCode::invalidArgument, "this camera can't be used", "--view",
                     "the field of view must lie between 0 and 180 degrees, the height above 0"};
    return camera;
}

// Drives a session with one cloud up to a deadline.
class Loader {
  public:
    Loader(ViewSession& session, std::string name, const PictureRequest& request)
        : session_(session), name_(std::move(name)), timeout_(request.timeout),
          deadline_(Clock::now() + request.timeout) {}

    template <class Done>
    Status until(const Done& done) {
        while (!done()) {
            if (Clock::now() >= deadline_)
                return timeOut();
            session_.update(updateWait);
            for (const CloudState& cloud : session_.clouds())
                if (cloud.stage == CloudStage::failed)
                    return cloud.error;
        }
        std::vector<Error> errors = session_.recentErrors();
        return errors.empty() ? Status() : Status(errors.front());
    }

  private:
    Status timeOut() const {
        bool address = name_.find("://") != std::string::npos;
        return Error{address ? ErrorCode::networkFailed : ErrorCode::limitExceeded,
                     cat("not everything that the picture needs has arrived within ",
                         static_cast<double>(timeout_.count()) * 1e-3, " s"),
                     name_, "lower --budget or raise --timeout"};
    }

    ViewSession& session_;
    std::string name_;
    std::chrono::milliseconds timeout_;
    Clock::time_point deadline_;
};

Status drawWithGles(FramePlan& plan, Picture& picture) {
    STIPPLE_TRY(context, EglContext::create());
    STIPPLE_TRY(renderer, GlesRenderer::create());
    picture.renderer = context->driver();
    auto start = Clock::now();
    STIPPLE_TRY(target, context->framebuffer(plan.width, plan.height));
    STIPPLE_CHECK(renderer->draw(plan, target));
    STIPPLE_TRY(image, context->read());
    picture.drawSeconds = secondsSince(start);
    picture.image = std::move(image);
    renderer.reset(); // frees its objects while the context is there
    return {};
}

void drawWithSoftware(FramePlan& plan, int threads, Picture& picture) {
    auto renderer = SoftwareRenderer::create(threads);
    picture.renderer = "software";
    auto start = Clock::now();
    picture.image = renderer->render(plan);
    picture.drawSeconds = secondsSince(start);
}

} // namespace

Status checkRequest(const PictureRequest& request) {
    if (std::min(request.width, request.height) < 1 ||
        std::max(request.width, request.height) > maxPictureSide)
        return Error{ErrorCode::invalidArgument,
                     cat("a picture of ", request.width, " × ", request.height, " pixels can't be drawn"),
                     "--size", cat("each side must be in 1..", maxPictureSide)};
    BoxD anywhere{{0, 0, 0}, {1, 1, 1}};
    STIPPLE_TRY(camera, cameraOf(request, anywhere));
    (void)camera;
    return {};
}

Result<Picture> drawPicture(std::unique_ptr<ByteSource> source, const PictureRequest& request) {
    STIPPLE_CHECK(checkRequest(request));
    auto start = Clock::now();
    auto decoder = makeThreadDecoder(request.threads);
    auto session = ViewSession::create(*decoder, request.limits);
    session->setViewport(request.width, request.height);
    session->setStyle(request.style);
    // Nothing is wanted before the camera is known.
    SessionLimits opening = request.limits;
    opening.pointBudget = 0;
    session->setLimits(opening);

    std::string name = source->name();
    Loader loader(*session, name, request);
    session->addCloud(std::move(source), name);
    STIPPLE_CHECK(loader.until([&] { return session->clouds().front().stage == CloudStage::ready; }));
    Picture picture;
    picture.openSeconds = secondsSince(start);

    STIPPLE_TRY(camera, cameraOf(request, session->contentBounds()));
    session->setCamera(camera);
    session->setLimits(request.limits);
    bool firstIsEnough = request.until == Until::first;
    STIPPLE_CHECK(loader.until(
        [&] { return session->settled() || (firstIsEnough && session->plan().counters.pointsDrawn > 0); }));
    picture.loadSeconds = secondsSince(start) - picture.openSeconds;

    FramePlan plan = session->plan();
    if (request.backend == Backend::gles)
        STIPPLE_CHECK(drawWithGles(plan, picture));
    else
        drawWithSoftware(plan, request.threads, picture);
    picture.camera = camera;
    picture.frame = plan.counters;
    picture.session = session->counters();
    return picture;
}

} // namespace stipple::headless
