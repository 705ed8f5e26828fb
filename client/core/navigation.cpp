#include "client/core/navigation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stipple {

namespace {

constexpr double radiansPerDegree = std::numbers::pi / 180;
constexpr double horizonDistances = 20; // dragGround()
constexpr double flightCurve = std::numbers::sqrt2;

struct Axes {
    Vec3d right, up, forward;
};
Axes axesOf(const Camera& camera) {
    ViewTransform view = viewTransform(camera, 1, 1, {});
    return {view.right, view.up, view.forward};
}

bool isFinite(Vec3d v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
// `changed`, unless its numbers do not hold, or its direction has dissolved in its coordinates.
Camera keptIfSound(const Camera& changed, const Camera& before) {
    double magnitude = std::max({length(changed.position), length(changed.target), 1e-6});
    bool sound = isUsable(changed) && length(changed.target - changed.position) > magnitude * 1e-13;
    return sound ? changed : before;
}
Camera moved(const Camera& camera, Vec3d step) {
    Camera result = camera;
    result.position = camera.position + step;
    result.target = camera.target + step;
    return keptIfSound(result, camera);
}

double halfSlope(const Camera& camera) {
    return std::tan(camera.fovYDegrees * radiansPerDegree / 2);
}

// The ray under a pixel: perspective from the position, orthographic from the plane of the position.
struct Ray {
    Vec3d from, direction; // direction · forward = 1
};
Ray rayThrough(const Camera& camera, const Axes& axes, double x, double y, int width, int height) {
    double across = (2 * x - width) / height, upwards = (height - 2 * y) / height;
    if (camera.projection == Projection::orthographic) {
        double half = camera.orthoHeight / 2;
        return {camera.position + axes.right * (across * half) + axes.up * (upwards * half), axes.forward};
    }
    double slope = halfSlope(camera);
    return {camera.position, axes.forward + axes.right * (across * slope) + axes.up * (upwards * slope)};
}

// `v` of the axes `from`, turned into the axes `to`.
Vec3d turned(Vec3d v, const Axes& from, const Axes& to) {
    return to.right * dot(v, from.right) + to.up * dot(v, from.up) + to.forward * dot(v, from.forward);
}

// Between unit vectors; opposite ones by way of `side`.
Vec3d between(Vec3d a, Vec3d b, double t, Vec3d side) {
    double angle = 2 * std::atan2(length(a - b), length(a + b));
    if (angle < 1e-9)
        return normalized(a * (1 - t) + b * t);
    if (angle > std::numbers::pi - 1e-6)
        return t < 0.5 ? between(a, side, 2 * t, side) : between(side, b, 2 * t - 1, side);
    return normalized(a * (std::sin((1 - t) * angle) / std::sin(angle)) +
                      b * (std::sin(t * angle) / std::sin(angle)));
}

// Height of the view at its target.
double viewHeight(const Camera& camera) {
    return camera.projection == Projection::orthographic
               ? camera.orthoHeight
               : 2 * halfSlope(camera) * length(camera.target - camera.position);
}

} // namespace

Camera orbitAbout(const Camera& camera, Vec3d pivot, double dx, double dy, int height) {
    if (!isFinite(pivot))
        return camera;
    Axes before = axesOf(camera), after = axesOf(orbit(camera, dx, dy, height));
    Camera result = camera;
    result.position = pivot + turned(camera.position - pivot, before, after);
    result.target = pivot + turned(camera.target - pivot, before, after);
    return keptIfSound(result, camera);
}

Camera dragAtDepth(const Camera& camera, Vec3d grabbed, double x, double y, int width, int height) {
    Axes axes = axesOf(camera);
    double depth = dot(grabbed - camera.position, axes.forward);
    bool isSeen = camera.projection == Projection::orthographic || depth > 0;
    if (!isFinite(grabbed) || !isSeen)
        return camera;
    Ray ray = rayThrough(camera, axes, x, y, width, height);
    return moved(camera, grabbed - (ray.from + ray.direction * depth));
}

Camera dragGround(const Camera& camera, Vec3d grabbed, double x, double y, int width, int height) {
    Axes axes = axesOf(camera);
    Vec3d up = normalized(camera.up);
    Ray ray = rayThrough(camera, axes, x, y, width, height);
    double rise = dot(ray.direction, up), t = dot(grabbed - ray.from, up) / rise;
    double limit = horizonDistances * length(grabbed - camera.position);
    bool isSeen = camera.projection == Projection::orthographic || t > 0;
    bool isBehind =
        camera.projection == Projection::perspective && !(dot(grabbed - camera.position, axes.forward) > 0);
    if (isBehind || length(up) == 0 || rise == 0 || !isSeen ||
        !(std::abs(t) * length(ray.direction) <= limit))
        return dragAtDepth(camera, grabbed, x, y, width, height);
    Vec3d step = grabbed - (ray.from + ray.direction * t);
    return moved(camera, step - up * dot(step, up));
}

Camera zoomToPoint(const Camera& camera, Vec3d point, double factor) {
    if (!(factor > 0) || !isFinite(point))
        return camera;
    Camera result = camera;
    result.position = point + (camera.position - point) * factor;
    result.target = point + (camera.target - point) * factor;
    result.orthoHeight = camera.orthoHeight * factor;
    return keptIfSound(result, camera);
}

Camera lookAround(const Camera& camera, double dx, double dy, int height) {
    // orbit() turns by half a turn a height; the content under the pointer moves by the field of view.
    double part = camera.projection == Projection::perspective ? camera.fovYDegrees / 180 : 1.0 / 3;
    Camera orbited = orbit(camera, -dx * part, -dy * part, height);
    Camera result = camera;
    result.target = camera.position + (orbited.target - orbited.position);
    return keptIfSound(result, camera);
}

Camera walk(const Camera& camera, const Walk& step) {
    Axes axes = axesOf(camera);
    Vec3d up = length(camera.up) > 0 ? normalized(camera.up) : axes.up;
    Vec3d forward = step.level ? normalized(cross(up, axes.right)) : axes.forward;
    Vec3d sideways = axes.right * step.right + up * step.up;
    if (camera.projection == Projection::perspective)
        return moved(camera, forward * step.forward + sideways);
    Camera result = moved(camera, sideways + (step.level ? forward * step.forward : Vec3d{}));
    if (!step.level)
        result.orthoHeight *= std::exp(-step.forward / camera.orthoHeight);
    return keptIfSound(result, camera);
}

Camera facing(const Camera& camera, Vec3d point, double part) {
    if (!(part > 0) || !isFinite(point))
        return camera;
    Axes axes = axesOf(camera);
    double distance = camera.projection == Projection::perspective
                          ? dot(point - camera.position, axes.forward) * part
                          : length(camera.target - camera.position);
    Camera result = camera;
    result.target = point;
    result.position =
        point - axes.forward * (distance > 0 ? distance : length(point - camera.position) * part);
    result.orthoHeight = camera.orthoHeight * part;
    return keptIfSound(result, camera);
}

Flight::Flight(const Camera& from, const Camera& to)
    : from_(from), to_(withProjection(to, from.projection)), arrival_(to), startWidth_(viewHeight(from)),
      endWidth_(viewHeight(to_)), way_(stipple::length(to.target - from.target)),
      isStraight_(!(way_ > 1e-9 * std::max(startWidth_, endWidth_))) {
    constexpr double rho2 = flightCurve * flightCurve;
    auto rAt = [&](double width, double sign) {
        double b = (endWidth_ * endWidth_ - startWidth_ * startWidth_ + sign * rho2 * rho2 * way_ * way_) /
                   (2 * width * rho2 * way_);
        return -std::asinh(b);
    };
    if (isStraight_) {
        path_ = std::abs(std::log(endWidth_ / startWidth_)) / flightCurve;
    } else {
        r0_ = rAt(startWidth_, 1);
        path_ = (rAt(endWidth_, -1) - r0_) / flightCurve;
    }
    Axes a = axesOf(from_), b = axesOf(to_);
    length_ = std::max(path_, stipple::length(a.forward - b.forward) + stipple::length(a.up - b.up));
}

double Flight::widthAt(double s) const {
    if (isStraight_)
        return startWidth_ * std::pow(endWidth_ / startWidth_, path_ > 0 ? s / path_ : 0);
    return startWidth_ * std::cosh(r0_) / std::cosh(flightCurve * s + r0_);
}

double Flight::shareAt(double s) const {
    if (isStraight_)
        return path_ > 0 ? s / path_ : 0;
    constexpr double rho2 = flightCurve * flightCurve;
    return startWidth_ / rho2 * (std::cosh(r0_) * std::tanh(flightCurve * s + r0_) - std::sinh(r0_)) / way_;
}

Camera Flight::at(double t) const {
    if (!(t > 0))
        return from_;
    if (t >= 1)
        return arrival_;
    double eased = t * t * (3 - 2 * t), s = eased * path_;
    Axes start = axesOf(from_), end = axesOf(to_);
    Vec3d forward = between(start.forward, end.forward, eased, start.up);
    Camera camera = from_;
    camera.up = between(normalized(from_.up), normalized(to_.up), eased, start.right);
    camera.target = from_.target + (to_.target - from_.target) * shareAt(s);
    camera.fovYDegrees = from_.fovYDegrees + (to_.fovYDegrees - from_.fovYDegrees) * eased;
    double width = widthAt(s), distance = width / (2 * halfSlope(camera));
    if (camera.projection == Projection::orthographic) {
        double near = stipple::length(from_.target - from_.position);
        distance = near * std::pow(stipple::length(to_.target - to_.position) / near, eased);
    }
    camera.orthoHeight = width;
    camera.position = camera.target - forward * distance;
    return keptIfSound(camera, from_);
}

} // namespace stipple
