#include "client/core/camera_track.hpp"

#include "client/core/json.hpp"
#include "shared/base/json_fields.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stipple {

namespace {

constexpr double longestSeconds = 3600;
constexpr double turn = 2 * std::numbers::pi;
// Views nearer to the pole than this have no heading of their own: what is right in the picture tells it.
constexpr double poleSlack = 1e-6;

Error refused(std::size_t index, Phrase what) {
    return {ErrorCode::invalidArgument, std::move(what), cat("keyframes[", index, "]"), ""};
}

Status checked(const std::vector<Keyframe>& keyframes) {
    if (keyframes.empty() || keyframes.size() > maxKeyframes)
        return Error{ErrorCode::invalidArgument, say("a camera path has 1 to ", maxKeyframes, " keyframes"),
                     "keyframes", ""};
    for (std::size_t i = 0; i < keyframes.size(); ++i) {
        const Camera& camera = keyframes[i].camera;
        if (!isUsable(camera) || camera.position == camera.target || length(camera.up) == 0)
            return refused(i, say("the camera looks nowhere: its position, target and up must say where to"));
        if (camera.projection != keyframes[0].camera.projection)
            return refused(i, say("the cameras of a path must all be perspective, or all orthographic"));
        if (i > 0 && !(keyframes[i].seconds > 0 && keyframes[i].seconds <= longestSeconds))
            return refused(i, say("'seconds' must be more than 0 and at most ", longestSeconds));
    }
    return {};
}

// The slope at a keyframe between stretches of `before` and `after` seconds along which the value rises by
// `a` and `b` a second: 0 at a turning point, else their weighted harmonic mean.
double slopeBetween(double before, double a, double after, double b) {
    if (!(a * b > 0))
        return 0;
    double w1 = 2 * after + before, w2 = after + 2 * before;
    return (w1 + w2) / (w1 / a + w2 / b);
}

// Cubic Hermite at t in 0..1 of a stretch of `seconds`; what rounding puts outside of [from, to] is brought
// back.
double between(double from, double to, double slopeFrom, double slopeTo, double seconds, double t) {
    double share = t * t * (3 - 2 * t), rest = 1 - t;
    double value = from + (to - from) * share + seconds * t * rest * (slopeFrom * rest - slopeTo * t);
    return std::clamp(value, std::min(from, to), std::max(from, to));
}

} // namespace

Result<CameraTrack> CameraTrack::make(std::vector<Keyframe> keyframes) {
    STIPPLE_CHECK(checked(keyframes));
    CameraTrack track;
    track.keyframes_ = std::move(keyframes);
    track.pole_ = normalized(track.keyframes_[0].camera.up);
    Vec3d aside = std::abs(track.pole_.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    track.east_ = normalized(aside - track.pole_ * dot(aside, track.pole_));
    track.north_ = cross(track.pole_, track.east_);
    double time = 0;
    for (const Keyframe& keyframe : track.keyframes_) {
        time += track.times_.empty() ? 0 : keyframe.seconds;
        track.times_.push_back(time);
        Values values = track.valuesOf(keyframe.camera);
        if (!track.values_.empty())
            for (Quantity angle : {heading, roll})
                values[angle] += turn * std::round((track.values_.back()[angle] - values[angle]) / turn);
        track.values_.push_back(values);
    }
    track.setSlopes();
    return track;
}

void CameraTrack::setSlopes() {
    slopes_.assign(values_.size(), Values{}); // at rest at both ends
    for (std::size_t i = 1; i + 1 < values_.size(); ++i) {
        double before = times_[i] - times_[i - 1], after = times_[i + 1] - times_[i];
        for (std::size_t q = 0; q < quantities; ++q)
            slopes_[i][q] = slopeBetween(before, (values_[i][q] - values_[i - 1][q]) / before, after,
                                         (values_[i + 1][q] - values_[i][q]) / after);
    }
}

CameraTrack::Values CameraTrack::valuesOf(const Camera& camera) const {
    ViewTransform view = viewTransform(camera, 1, 1, {});
    Vec3d level = cross(view.forward, pole_);
    Vec3d right = length(level) > poleSlack ? normalized(level) : view.right;
    Vec3d up = cross(right, view.forward);
    Values values{};
    values[x] = camera.position.x;
    values[y] = camera.position.y;
    values[z] = camera.position.z;
    values[heading] = std::atan2(dot(right, north_), dot(right, east_));
    values[elevation] = std::atan2(dot(view.forward, pole_), length(level));
    values[roll] = std::atan2(dot(view.up, right), dot(view.up, up));
    values[fieldOfView] = camera.fovYDegrees;
    values[logDistance] = std::log(length(camera.target - camera.position));
    values[logHeight] = std::log(camera.orthoHeight);
    return values;
}

Camera CameraTrack::cameraOf(const Values& values) const {
    Vec3d right = east_ * std::cos(values[heading]) + north_ * std::sin(values[heading]);
    Vec3d level = cross(pole_, right);
    Vec3d forward = level * std::cos(values[elevation]) + pole_ * std::sin(values[elevation]);
    Vec3d up = cross(right, forward);
    Camera camera = keyframes_[0].camera;
    camera.position = {values[x], values[y], values[z]};
    camera.target = camera.position + forward * std::exp(values[logDistance]);
    bool isUpright = std::abs(values[roll]) < 1e-9 && std::cos(values[elevation]) > poleSlack;
    camera.up = isUpright ? pole_ : up * std::cos(values[roll]) + right * std::sin(values[roll]);
    camera.fovYDegrees = values[fieldOfView];
    camera.orthoHeight = std::exp(values[logHeight]);
    return camera;
}

Camera CameraTrack::at(double seconds) const {
    if (!(seconds > 0))
        return keyframes_.front().camera;
    auto after = std::lower_bound(times_.begin(), times_.end(), seconds);
    if (after == times_.end())
        return keyframes_.back().camera;
    auto to = static_cast<std::size_t>(after - times_.begin()), from = to - 1;
    if (*after == seconds)
        return keyframes_[to].camera;
    double span = times_[to] - times_[from], t = (seconds - times_[from]) / span;
    Values values{};
    for (std::size_t q = 0; q < quantities; ++q)
        values[q] = between(values_[from][q], values_[to][q], slopes_[from][q], slopes_[to][q], span, t);
    return cameraOf(values);
}

Result<CameraTrack> cameraTrackFromJson(std::string_view text) {
    using nlohmann::json;
    STIPPLE_TRY(value, parseJson(text, "camera path"));
    std::vector<Keyframe> keyframes;
    json_fields::FieldReader fields(value, "camera path");
    fields.list("keyframes", maxKeyframes, [&](const json& item, const std::string& path) -> Status {
        Keyframe keyframe;
        json rest = item;
        if (item.is_object() && item.contains("camera")) {
            STIPPLE_TRY(camera, cameraFromJson(item["camera"]));
            keyframe.camera = camera;
            rest.erase("camera");
        }
        json_fields::FieldReader one(rest, path);
        one.number("seconds", keyframe.seconds, 0, longestSeconds);
        keyframes.push_back(keyframe);
        return one.finish();
    });
    STIPPLE_CHECK(fields.finish());
    return CameraTrack::make(std::move(keyframes));
}

} // namespace stipple
