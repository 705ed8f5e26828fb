#include "client/headless/picture.hpp"

#include "client/core/json.hpp"
#include "client/headless/session_loader.hpp"
#include "client/headless/thread_decoder.hpp"
#include "client/render/raster_setup.hpp"
#include "shared/base/text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace stipple::headless {
namespace {

using Clock = std::chrono::steady_clock;

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
    SessionLoader loader(*session, name, request.timeout);
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
    STIPPLE_TRY(drawer, FrameDrawer::create(request.backend, request.threads));
    picture.renderer = drawer->name();
    start = Clock::now();
    STIPPLE_TRY(image, drawer->draw(plan));
    picture.drawSeconds = secondsSince(start);
    picture.image = *image;
    picture.camera = camera;
    picture.frame = plan.counters;
    picture.session = session->counters();
    return picture;
}

} // namespace stipple::headless
