#include "client/headless/picture.hpp"

#include "client/core/attribute_needs.hpp"
#include "client/core/json.hpp"
#include "client/headless/session_loader.hpp"
#include "client/headless/thread_decoder.hpp"
#include "client/render/raster_setup.hpp"
#include "client/render/software_renderer.hpp"
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
                     "choose top, front, side or iso, or give a camera as JSON"};
    STIPPLE_TRY(json, parseJson(request.view, "--view"));
    STIPPLE_TRY(camera, cameraFromJson(json, namedCamera(NamedView::iso, content, aspect, projection)));
    if (request.projection)
        camera.projection = *request.projection;
    if (!isUsable(camera))
        return Error{ErrorCode::invalidArgument, "this camera can't be used", "--view",
                     "the field of view must lie between 0 and 180 degrees, the height above 0"};
    return camera;
}

class Session final : public PictureSession {
  public:
    Session(std::unique_ptr<ByteSource> source, const PictureRequest& request)
        : name_(source->name()), decoder_(makeThreadDecoder(request.threads)),
          session_(ViewSession::create(*decoder_, withoutPoints(request.limits))) {
        session_->addCloud(std::move(source), name_);
    }

    Status waitUntilOpen(const PictureRequest& request) {
        SessionLoader loader(*session_, name_, request.timeout, request.stop);
        return loader.until([&] { return session_->clouds().front().stage == CloudStage::ready; });
    }

    Result<Picture> draw(const PictureRequest& request) override {
        Image image{request.width, 0, {}};
        STIPPLE_TRY(picture, draw(request, [&](const Image& rows) {
                        image.rgba.insert(image.rgba.end(), rows.rgba.begin(), rows.rgba.end());
                        image.height += rows.height;
                        return Status();
                    }));
        picture.image = std::move(image);
        return std::move(picture);
    }

    Result<Picture> draw(const PictureRequest& request, const TakeRows& take) override {
        auto start = Clock::now();
        Picture picture;
        STIPPLE_TRY(camera, load(request));
        picture.loadSeconds = secondsSince(start);

        FramePlan plan = session_->plan();
        STIPPLE_TRY(drawer, FrameDrawer::create(request.backend, request.threads));
        picture.renderer = drawer->name();
        start = Clock::now();
        STIPPLE_CHECK(drawRows(*drawer, plan, take));
        picture.drawSeconds = secondsSince(start);
        picture.camera = camera;
        picture.frame = plan.counters;
        for (std::string sentence : {lack(request.style), drawer->limitation()})
            if (!sentence.empty())
                picture.limitations.push_back(std::move(sentence));
        picture.session = session_->counters();
        return picture;
    }

    Result<std::optional<PickedPoint>> pick(const PictureRequest& request,
                                            const PickRequest& pointer) override {
        STIPPLE_TRY(camera, load(request));
        (void)camera;
        auto renderer = SoftwareRenderer::create(request.threads);
        std::optional<PickHit> hit = renderer->pick(session_->plan(), pointer);
        if (!hit)
            return std::optional<PickedPoint>();
        PickedPoint picked;
        picked.identity = {hit->cloud, hit->node->key, hit->point};
        picked.pixelsAway = hit->pixelsAway;
        picked.distance = hit->distance;
        STIPPLE_CHECK(session_->askPoint(picked.identity));
        SessionLoader loader(*session_, name_, request.timeout, request.stop);
        STIPPLE_CHECK(loader.until([&] { return !session_->pointsPending(); }));
        for (PointAnswer& answer : session_->takePointAnswers())
            if (answer.point == picked.identity) {
                STIPPLE_TRY(record, std::move(answer.record));
                picked.record = std::move(record);
            }
        return std::optional(std::move(picked));
    }

  private:
    // See lackOf().
    std::string lack(const Style& style) const {
        return lackOf(style, *session_->clouds().front().metadata, name_);
    }

    // Loads what the request wants to be seen.
    Result<Camera> load(const PictureRequest& request) {
        STIPPLE_CHECK(checkRequest(request));
        STIPPLE_TRY(camera, cameraOf(request, session_->contentBounds()));
        session_->setViewport(request.width, request.height);
        session_->setStyle(request.style);
        session_->setCamera(camera);
        session_->setLimits(request.limits);
        session_->update(); // what was settled for another picture is not for this one
        SessionLoader loader(*session_, name_, request.timeout, request.stop);
        bool firstIsEnough = request.until == Until::first;
        STIPPLE_CHECK(loader.until([&] {
            return session_->settled() || (firstIsEnough && session_->plan().counters.pointsDrawn > 0);
        }));
        return camera;
    }

    // Nothing is wanted before the camera is known.
    static SessionLimits withoutPoints(SessionLimits limits) {
        limits.pointBudget = 0;
        return limits;
    }

    std::string name_;
    std::unique_ptr<NodeDecoder> decoder_; // outlives the session
    std::unique_ptr<ViewSession> session_;
};

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

Result<std::unique_ptr<PictureSession>> PictureSession::open(std::unique_ptr<ByteSource> source,
                                                             const PictureRequest& request) {
    auto session = std::make_unique<Session>(std::move(source), request);
    STIPPLE_CHECK(session->waitUntilOpen(request));
    return std::unique_ptr<PictureSession>(std::move(session));
}

Result<Picture> drawPicture(std::unique_ptr<ByteSource> source, const PictureRequest& request,
                            const TakeRows& take) {
    STIPPLE_CHECK(checkRequest(request));
    auto start = Clock::now();
    STIPPLE_TRY(session, PictureSession::open(std::move(source), request));
    PictureRequest rest = request;
    double openSeconds = secondsSince(start);
    rest.timeout -= std::chrono::milliseconds(static_cast<std::int64_t>(openSeconds * 1000));
    STIPPLE_TRY(picture, take ? session->draw(rest, take) : session->draw(rest));
    picture.openSeconds = openSeconds;
    return std::move(picture);
}

} // namespace stipple::headless
