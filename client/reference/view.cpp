#include "client/reference/view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stipple::reference {
namespace {

Vec3l wide(Vec3d v) {
    return {v.x, v.y, v.z};
}
Vec3d narrow(const Vec3l& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
long double lengthOf(const Vec3l& v) {
    return std::sqrt(dot(v, v));
}
Vec3l unit(const Vec3l& v) {
    long double size = lengthOf(v);
    return size > 0 ? v * (1 / size) : v;
}

// The hint for up, or what takes its place where it is parallel to the direction (sine below 1e-7).
Vec3l upHint(const Vec3l& forward, const Camera& camera) {
    Vec3l hint = unit(wide(camera.up));
    if (lengthOf(cross(forward, hint)) >= 1e-7L)
        return hint;
    return std::abs(forward.y) < 0.9L ? Vec3l{0, 1, 0} : Vec3l{0, 0, 1};
}

struct Depths {
    long double nearest, farthest;
};
Depths depthsOf(const BoxD& content, const Vec3l& from, const Vec3l& forward, long double targetDistance) {
    if (content.empty())
        return {targetDistance, targetDistance};
    long double nearest = 0, farthest = 0; // each axis has its own nearest and farthest side
    for (int axis = 0; axis < 3; ++axis) {
        long double a = (static_cast<long double>(content.min[axis]) - from[axis]) * forward[axis];
        long double b = (static_cast<long double>(content.max[axis]) - from[axis]) * forward[axis];
        nearest += std::min(a, b);
        farthest += std::max(a, b);
    }
    return {nearest, farthest};
}

} // namespace

View viewOf(const Camera& camera, int width, int height, const BoxD& content) {
    Vec3l position = wide(camera.position), toTarget = wide(camera.target) - position;
    long double targetDistance = lengthOf(toTarget);
    Vec3l forward = targetDistance > 0 ? unit(toTarget) : Vec3l{0, 1, 0};
    if (targetDistance == 0)
        targetDistance = 1;
    Vec3l right = unit(cross(forward, upHint(forward, camera)));

    View view;
    view.width = width;
    view.height = height;
    view.projection = camera.projection;
    view.forward = narrow(forward);
    view.right = narrow(right);
    view.up = narrow(cross(right, forward));
    view.eye = position;
    long double slope =
        std::tan(static_cast<long double>(camera.fovYDegrees) * std::numbers::pi_v<long double> / 360);
    if (camera.projection == Projection::perspective) {
        view.pixelsPerUnit = static_cast<double>(height / (2 * slope));
        return view;
    }
    view.pixelsPerUnit = height / camera.orthoHeight;
    long double likePerspective = static_cast<long double>(camera.orthoHeight) / 2 / slope;
    Depths depths = depthsOf(content, position, forward, targetDistance);
    long double margin = 0.01L * likePerspective + 0.001L * (depths.farthest - depths.nearest);
    view.eye = position + forward * std::min(targetDistance - likePerspective, depths.nearest - margin);
    return view;
}

bool place(const View& view, const Vec3l& world, Place& at) {
    Vec3d relative = narrow(world - view.eye);
    at.distance = dot(relative, view.forward);
    if (!(at.distance > 0 && at.distance >= view.near && at.distance <= view.far))
        return false;
    double pixels = view.pixelsPerUnitAt(at.distance);
    at.x = 0.5 * view.width + dot(relative, view.right) * pixels;
    at.y = 0.5 * view.height - dot(relative, view.up) * pixels;
    return true;
}

} // namespace stipple::reference
