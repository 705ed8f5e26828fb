#include "client/core/camera.hpp"

#include "client/core/view_fit.hpp"

#include <algorithm>
#include <array>
#include <numbers>

namespace stipple {

namespace {

constexpr double radiansPerDegree = std::numbers::pi / 180;
// Nearest the direction may come to the up axis while orbiting; there the azimuth is still well defined.
constexpr double poleGapRadians = 0.01 * radiansPerDegree;
// How much of the picture's width or height a named view fills.
constexpr double filledPart = 0.96;
// Logarithmic depth keeps 24 bits for log2(far / near): at this ratio a step is 2^-19 of the distance or
// less, and a content of the size of a planet still shows points a centimetre away.
constexpr double smallestNearToFar = 0x1p-31;

bool isFinite(Vec3d v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Divides instead of multiplying by the inverse: a direction along an axis stays exactly on it.
Vec3d unit(Vec3d v) {
    double size = length(v);
    return size > 0 ? Vec3d{v.x / size, v.y / size, v.z / size} : v;
}

struct Axes {
    Vec3d right, up, forward;
};

// Right-handed orthonormal axes for a unit direction and a hint for up.
Axes axesFor(Vec3d forward, Vec3d upHint) {
    Vec3d hint = unit(upHint);
    // sin² of the angle below 1e-14: the hint says nothing any more.
    if (dot(cross(forward, hint), cross(forward, hint)) < 1e-14)
        hint = std::abs(forward.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
    Vec3d right = unit(cross(forward, hint));
    return {right, cross(right, forward), forward};
}

Axes axesOf(const Camera& camera) {
    Vec3d forward = unit(camera.target - camera.position);
    if (length(forward) == 0)
        forward = {0, 1, 0};
    return axesFor(forward, camera.up);
}

std::array<Vec3d, 8> cornersOf(const BoxD& box) {
    std::array<Vec3d, 8> corners;
    for (std::size_t i = 0; i < 8; ++i)
        corners[i] = {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                      i & 4 ? box.max.z : box.min.z};
    return corners;
}

// Rodrigues' rotation of `v` around the unit `axis`.
Vec3d rotated(Vec3d v, Vec3d axis, double radians) {
    double c = std::cos(radians), s = std::sin(radians);
    return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

struct DepthRange {
    double nearest, farthest;
};

// View distances of `content` from `from`; of the target when there is no content.
DepthRange depthsOf(const BoxD& content, Vec3d from, Vec3d forward, double targetDistance) {
    if (content.empty())
        return {targetDistance, targetDistance};
    DepthRange range{HUGE_VAL, -HUGE_VAL};
    for (Vec3d corner : cornersOf(content)) {
        double depth = dot(corner - from, forward);
        range.nearest = std::min(range.nearest, depth);
        range.farthest = std::max(range.farthest, depth);
    }
    return range;
}

// Widens by a tenth, so that rounding in float loses no point at either end.
void enclose(ViewTransform& view, DepthRange depths) {
    view.far = depths.farthest * 1.1;
    view.near = std::max(depths.nearest * 0.9, view.far * smallestNearToFar);
}

Camera keptIfUsable(const Camera& changed, const Camera& before) {
    return isUsable(changed) ? changed : before;
}

} // namespace

bool isUsable(const Camera& camera) {
    return isFinite(camera.position) && isFinite(camera.target) && isFinite(camera.up) &&
           camera.fovYDegrees > 0 && camera.fovYDegrees < 180 && camera.orthoHeight > 0 &&
           std::isfinite(camera.orthoHeight);
}

ViewTransform viewTransform(const Camera& camera, int width, int height, const BoxD& content) {
    ViewTransform view;
    Axes axes = axesOf(camera);
    view.projection = camera.projection;
    view.right = axes.right;
    view.up = axes.up;
    view.forward = axes.forward;
    view.tanHalfFovY = std::tan(camera.fovYDegrees * radiansPerDegree / 2);
    view.halfHeight = camera.orthoHeight / 2;
    view.aspect = static_cast<double>(width) / height;
    view.eye = camera.position;

    double targetDistance = length(camera.target - camera.position);
    if (targetDistance == 0)
        targetDistance = 1;
    DepthRange depths = depthsOf(content, camera.position, axes.forward, targetDistance);
    if (camera.projection == Projection::orthographic) {
        // The eye stands where a perspective camera would see the target at this height, so that depth
        // shading looks the same in both; farther back where content would come to lie behind it.
        double likePerspective = view.halfHeight / view.tanHalfFovY;
        double margin = 0.01 * likePerspective + 0.001 * (depths.farthest - depths.nearest);
        double shift = std::min(targetDistance - likePerspective, depths.nearest - margin);
        view.eye = camera.position + axes.forward * shift;
        depths = {depths.nearest - shift, depths.farthest - shift};
    }
    if (depths.farthest <= 0) // all behind: nothing will be seen, but the numbers must hold
        depths = {targetDistance, targetDistance};
    enclose(view, depths);
    return view;
}

Vec3d projectToPixels(const ViewTransform& view, int width, int height, Vec3d world) {
    Vec3d relative = world - view.eye;
    double depth = dot(relative, view.forward);
    double halfView = view.projection == Projection::perspective ? view.tanHalfFovY * depth : view.halfHeight;
    double pixelsPerUnit = height / (2 * halfView);
    return {0.5 * width + dot(relative, view.right) * pixelsPerUnit,
            0.5 * height - dot(relative, view.up) * pixelsPerUnit, depth};
}

double unitsPerPixel(const Camera& camera, int height) {
    if (camera.projection == Projection::orthographic)
        return camera.orthoHeight / height;
    double distance = length(camera.target - camera.position);
    return 2 * distance * std::tan(camera.fovYDegrees * radiansPerDegree / 2) / height;
}

Camera fittedCamera(const Camera& looking, const BoxD& content, double aspect) {
    if (content.empty() || !isUsable(looking))
        return looking;
    Camera camera = looking;
    Axes axes = axesOf(camera);
    Vec3d centre = content.min + (content.max - content.min) * 0.5;
    double tanHalfFov = std::tan(camera.fovYDegrees * radiansPerDegree / 2);

    double halfHeight = 0, radius = 0;
    std::array<Vec3d, 8> corners = cornersOf(content); // in the camera's axes, from the centre
    for (Vec3d& corner : corners) {
        Vec3d relative = corner - centre;
        corner = {dot(relative, axes.right), dot(relative, axes.up), dot(relative, axes.forward)};
        halfHeight = std::max({halfHeight, std::abs(corner.y), std::abs(corner.x) / aspect});
        radius = std::max(radius, length(relative));
    }
    // Content that is flat along the view's height and width still needs a height.
    halfHeight = radius > 0 ? std::max(halfHeight / filledPart, radius * 1e-6) : tanHalfFov;
    camera.orthoHeight = 2 * halfHeight;

    Vec3d eye{0, 0, -1}; // a single point: any distance shows it
    if (camera.projection == Projection::orthographic)
        eye.z = -(halfHeight / tanHalfFov + radius);
    else if (radius > 0)
        eye = fittedEye(corners, tanHalfFov * aspect * filledPart, tanHalfFov * filledPart, radius * 1e-3);
    // The target stays at the centre's depth, so that turning goes around the content.
    camera.target = centre + axes.right * eye.x + axes.up * eye.y;
    camera.position = camera.target + axes.forward * eye.z;
    return camera;
}

Camera namedCamera(NamedView name, const BoxD& content, double aspect, Projection projection) {
    Camera camera;
    camera.projection = projection;
    if (content.empty())
        return camera;
    Vec3d forward = name == NamedView::top     ? Vec3d{0, 0, -1}
                    : name == NamedView::front ? Vec3d{0, 1, 0}
                    : name == NamedView::side  ? Vec3d{-1, 0, 0}
                                               : Vec3d{1, 1, -1};
    camera.position = {0, 0, 0};
    camera.target = forward;
    return fittedCamera(camera, content, aspect);
}

Camera orbit(const Camera& camera, double dx, double dy, int height) {
    Axes axes = axesOf(camera);
    Vec3d pole = unit(camera.up);
    double distance = length(camera.target - camera.position);
    if (length(pole) == 0 || distance == 0)
        return camera;
    double radiansPerPixel = std::numbers::pi / height;

    // Elevation of the view direction over the plane that `pole` is normal to; dragging down looks down.
    double elevation = std::atan2(dot(axes.forward, pole), length(cross(axes.forward, pole)));
    double highest = std::numbers::pi / 2 - poleGapRadians;
    double next = std::clamp(elevation - dy * radiansPerPixel, -highest, highest);
    // `right` is horizontal, also where the direction is the pole itself; it carries the azimuth.
    Vec3d right = unit(axes.right - pole * dot(axes.right, pole));
    right = rotated(right, pole, -dx * radiansPerPixel);
    Vec3d level = cross(pole, right);
    Vec3d forward = level * std::cos(next) + pole * std::sin(next);

    Camera turned = camera;
    turned.position = camera.target - forward * distance;
    return keptIfUsable(turned, camera);
}

Camera pan(const Camera& camera, double dx, double dy, int height) {
    Axes axes = axesOf(camera);
    double units = unitsPerPixel(camera, height);
    Vec3d step = axes.right * (-dx * units) + axes.up * (dy * units);
    Camera moved = camera;
    moved.position = camera.position + step;
    moved.target = camera.target + step;
    return keptIfUsable(moved, camera);
}

Camera zoomTo(const Camera& camera, double factor, double x, double y, int width, int height) {
    if (!(factor > 0))
        return camera;
    Axes axes = axesOf(camera);
    double units = unitsPerPixel(camera, height);
    Vec3d pointer =
        camera.target + axes.right * ((x - 0.5 * width) * units) + axes.up * ((0.5 * height - y) * units);
    // Everything shrinks towards the pointer's point: rays through it keep their direction.
    Camera zoomed = camera;
    zoomed.position = pointer + (camera.position - pointer) * factor;
    zoomed.target = pointer + (camera.target - pointer) * factor;
    zoomed.orthoHeight = camera.orthoHeight * factor;
    // Nearer than the coordinates' own resolution the direction would dissolve.
    double magnitude = std::max({length(zoomed.position), length(zoomed.target), 1e-6});
    bool resolvable = length(zoomed.target - zoomed.position) > magnitude * 1e-13;
    return resolvable ? keptIfUsable(zoomed, camera) : camera;
}

Camera withProjection(const Camera& camera, Projection projection) {
    if (camera.projection == projection)
        return camera;
    double halfSlope = std::tan(camera.fovYDegrees * radiansPerDegree / 2);
    Camera switched = camera;
    switched.projection = projection;
    if (projection == Projection::orthographic)
        switched.orthoHeight = 2 * halfSlope * length(camera.target - camera.position);
    else
        switched.position = camera.target - axesOf(camera).forward * (camera.orthoHeight / 2 / halfSlope);
    return keptIfUsable(switched, camera);
}

} // namespace stipple
