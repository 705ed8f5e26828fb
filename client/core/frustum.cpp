#include "client/core/frustum.hpp"

#include <cmath>
#include <limits>

namespace stipple {

namespace {
// Relative slack for what rounding can do to a projection; far above 2^-53, far below a pixel.
constexpr double slack = 1e-12;
} // namespace

Frustum::Frustum(const ViewTransform& view) : view_(view) {
    const std::array<Vec3d, 3> edges{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
    if (view.projection == Projection::orthographic) {
        // In the plane of the picture: its own two sides, and the normal of each projected box edge.
        axes_ = {view.right, view.up};
        for (Vec3d edge : edges)
            axes_.push_back(cross(edge, view.forward));
        return;
    }
    double x = view.tanHalfFovY * view.aspect, y = view.tanHalfFovY;
    for (std::size_t i = 0; i < 4; ++i)
        rays_[i] = normalized(view.forward + view.right * (i & 1 ? x : -x) + view.up * (i & 2 ? y : -y));
    // Normals of the pyramid's sides and of the box's, and every pair of an edge of each.
    axes_ = {view.forward * x - view.right, view.forward * x + view.right, view.forward * y - view.up,
             view.forward * y + view.up};
    axes_.insert(axes_.end(), edges.begin(), edges.end());
    for (Vec3d edge : edges)
        for (Vec3d ray : rays_)
            axes_.push_back(cross(edge, ray));
}

bool Frustum::intersects(const BoxD& box) const {
    if (box.empty())
        return false;
    Vec3d half = (box.max - box.min) * 0.5;
    Vec3d centre = (box.min - view_.eye) + half;
    for (Vec3d axis : axes_)
        if (separates(axis, centre, half))
            return false;
    return true;
}

bool Frustum::separates(Vec3d axis, Vec3d centre, Vec3d half) const {
    double middle = dot(axis, centre);
    double reach = std::abs(axis.x) * half.x + std::abs(axis.y) * half.y + std::abs(axis.z) * half.z;
    double tolerance = slack * length(axis) * (length(centre) + reach);
    if (view_.projection == Projection::orthographic) {
        double picture = std::abs(dot(axis, view_.right)) * view_.halfHeight * view_.aspect +
                         std::abs(dot(axis, view_.up)) * view_.halfHeight;
        return std::abs(middle) > reach + picture + tolerance;
    }
    // The pyramid covers [0, ∞), (-∞, 0] or everything along the axis, as its rays point.
    bool anyAhead = false, anyBehind = false;
    for (Vec3d ray : rays_) {
        double along = dot(axis, ray);
        anyAhead |= along > slack * length(axis);
        anyBehind |= along < -slack * length(axis);
    }
    if (anyAhead && anyBehind)
        return false;
    return (!anyBehind && middle + reach < -tolerance) || (!anyAhead && middle - reach > tolerance);
}

double projectedPixels(const ViewTransform& view, int height, Vec3d centre, double radius) {
    if (view.projection == Projection::orthographic)
        return radius / view.halfHeight * height / 2;
    double distance = length(centre - view.eye);
    if (distance <= radius)
        return std::numeric_limits<double>::infinity();
    return radius / (view.tanHalfFovY * distance) * height / 2;
}

} // namespace stipple
