// The viewer's camera: steps, flights, paths and named views.
#include "client/web/viewer.hpp"

#include "client/core/camera.hpp"
#include "client/core/json.hpp"

#include <nlohmann/json.hpp>

namespace stipple::web {

Status Viewer::setCamera(std::string_view json) {
    STIPPLE_TRY(camera, cameraFromJson(json, session_->camera()));
    session_->setCamera(camera);
    cameraWasSet_ = true;
    pendingView_.reset();
    return {};
}

std::string Viewer::cameraJson() const {
    return jsonText(toJson(session_->camera()));
}

void Viewer::orbit(double dx, double dy) {
    session_->setCamera(stipple::orbit(session_->camera(), dx, dy, height_));
}
void Viewer::pan(double dx, double dy) {
    session_->setCamera(stipple::pan(session_->camera(), dx, dy, height_));
}
void Viewer::zoom(double factor, double x, double y) {
    session_->setCamera(zoomTo(session_->camera(), factor, x, y, width_, height_));
}

void Viewer::orbitAbout(Vec3d pivot, double dx, double dy) {
    session_->setCamera(stipple::orbitAbout(session_->camera(), pivot, dx, dy, height_));
}
void Viewer::dragGround(Vec3d grabbed, double x, double y) {
    session_->setCamera(stipple::dragGround(session_->camera(), grabbed, x, y, width_, height_));
}
void Viewer::dragAtDepth(Vec3d grabbed, double x, double y) {
    session_->setCamera(stipple::dragAtDepth(session_->camera(), grabbed, x, y, width_, height_));
}
void Viewer::zoomToPoint(Vec3d point, double factor) {
    session_->setCamera(stipple::zoomToPoint(session_->camera(), point, factor));
}
void Viewer::lookAround(double dx, double dy) {
    session_->setCamera(stipple::lookAround(session_->camera(), dx, dy, height_));
}
void Viewer::walk(const Walk& step) {
    session_->setCamera(stipple::walk(session_->camera(), step));
}

double Viewer::begin(const Camera& destination) {
    pendingView_.reset();
    flight_.emplace(session_->camera(), destination);
    flown_ = session_->camera();
    return flight_->length();
}

Result<double> Viewer::flyToCamera(std::string_view json) {
    STIPPLE_TRY(camera, cameraFromJson(json, session_->camera()));
    return begin(camera);
}
double Viewer::flyToPoint(Vec3d point, double part) {
    return begin(facing(session_->camera(), point, part));
}
double Viewer::flyToCloud(CloudId id) {
    BoxD content = session_->contentBounds();
    for (const CloudState& cloud : session_->clouds())
        if (cloud.id == id && (cloud.metadata || !cloud.expected.empty()))
            content = cloud.metadata ? cloud.metadata->worldBounds() : cloud.expected;
    return content.empty() ? 0 : begin(fittedCamera(session_->camera(), content, aspect()));
}

bool Viewer::fly(double t) {
    if (!flight_ || session_->camera() != flown_) {
        flight_.reset();
        return false;
    }
    session_->setCamera(flight_->at(t));
    flown_ = session_->camera();
    if (t >= 1)
        flight_.reset();
    return true;
}

Result<double> Viewer::setTrack(std::string_view json) {
    STIPPLE_TRY(track, cameraTrackFromJson(json));
    track_ = std::move(track);
    return track_->duration();
}
bool Viewer::followTrack(double seconds) {
    if (!track_)
        return false;
    pendingView_.reset();
    session_->setCamera(track_->at(seconds));
    return true;
}

Status Viewer::showView(const std::string& name) {
    pendingView_ = namedViewFromName(name);
    if (!pendingView_)
        return Error{ErrorCode::invalidArgument, say("the views are top, front, side and iso"), name, ""};
    applyPendingView();
    return {};
}

Status Viewer::setProjection(const std::string& name) {
    nlohmann::json change{{"projection", name}};
    STIPPLE_TRY(camera, cameraFromJson(change, session_->camera()));
    session_->setCamera(withProjection(session_->camera(), camera.projection));
    return {};
}

void Viewer::applyPendingView() {
    BoxD content = session_->contentBounds();
    if (!pendingView_ || content.empty())
        return;
    session_->setCamera(namedCamera(*pendingView_, content, aspect(), session_->camera().projection));
    pendingView_.reset();
}

} // namespace stipple::web
