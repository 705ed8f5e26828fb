#include "client/core/frustum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stipple {

namespace {
// Relative slack for what rounding can do to a projection; far above 2^-53, far below a pixel.
constexpr double slack = 1e-12;

// A rectangle clipped by four planes has at most eight corners.
struct SpacePolygon {
    std::array<Vec3d, 8> corners;
    std::size_t count = 0;
    void add(Vec3d corner) { corners[std::min(count++, corners.size() - 1)] = corner; }
};

// The part on the side of the plane through the origin that `normal` points to.
SpacePolygon clipped(const SpacePolygon& polygon, Vec3d normal) {
    SpacePolygon result;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        Vec3d from = polygon.corners[i], to = polygon.corners[(i + 1) % polygon.count];
        double a = dot(from, normal), b = dot(to, normal);
        if (a >= 0)
            result.add(from);
        if ((a < 0) != (b < 0))
            result.add(from + (to - from) * (a / (a - b)));
    }
    return result;
}

SpacePolygon faceOf(Vec3d low, Vec3d high, int axis, bool upper) {
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    SpacePolygon face;
    for (int corner : {0, 1, 3, 2}) { // around
        Vec3d at;
        at[axis] = upper ? high[axis] : low[axis];
        at[u] = corner & 1 ? high[u] : low[u];
        at[v] = corner & 2 ? high[v] : low[v];
        face.add(at);
    }
    return face;
}
} // namespace

Frustum::Frustum(const ViewTransform& view) : view_(view) {
    const std::array<Vec3d, 3> edges{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
    if (view.projection == Projection::orthographic) {
        // In the plane of the picture: its own two sides, and the normal of each projected box edge.
        addAxis(view.right);
        addAxis(view.up);
        for (Vec3d edge : edges)
            addAxis(cross(edge, view.forward));
        return;
    }
    double x = view.tanHalfFovY * view.aspect, y = view.tanHalfFovY;
    for (std::size_t i = 0; i < 4; ++i)
        rays_[i] = normalized(view.forward + view.right * (i & 1 ? x : -x) + view.up * (i & 2 ? y : -y));
    // Normals of the pyramid's sides and of the box's, and every pair of an edge of each.
    for (Vec3d side : {view.forward * x - view.right, view.forward * x + view.right,
                       view.forward * y - view.up, view.forward * y + view.up})
        addAxis(side);
    for (Vec3d edge : edges)
        addAxis(edge);
    for (Vec3d edge : edges)
        for (Vec3d ray : rays_)
            addAxis(cross(edge, ray));
}

void Frustum::addAxis(Vec3d direction) {
    Axis axis{direction, length(direction), 0, 0};
    if (view_.projection == Projection::orthographic) {
        axis.high = std::abs(dot(direction, view_.right)) * view_.halfHeight * view_.aspect +
                    std::abs(dot(direction, view_.up)) * view_.halfHeight;
        axis.low = -axis.high;
    } else {
        // The pyramid covers [0, ∞), (-∞, 0] or everything along the axis, as its rays point.
        for (Vec3d ray : rays_) {
            double along = dot(direction, ray);
            if (along > slack * axis.length)
                axis.high = HUGE_VAL;
            if (along < -slack * axis.length)
                axis.low = -HUGE_VAL;
        }
        if (axis.high > 0 && axis.low < 0)
            return; // tells nothing
    }
    axes_.push_back(axis);
}

Sight Frustum::sightOf(const BoxD& box) const {
    if (box.empty())
        return Sight::outside;
    Vec3d half = (box.max - box.min) * 0.5;
    Vec3d centre = (box.min - view_.eye) + half;
    double away = length(centre);
    bool isPerspective = view_.projection == Projection::perspective;
    std::size_t bounds = isPerspective ? sides : sides / 2, inside = 0;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        const Axis& axis = axes_[i];
        double middle = dot(axis.direction, centre);
        double reach = std::abs(axis.direction.x) * half.x + std::abs(axis.direction.y) * half.y +
                       std::abs(axis.direction.z) * half.z;
        double tolerance = slack * axis.length * (away + reach);
        if (middle + reach < axis.low - tolerance || middle - reach > axis.high + tolerance)
            return Sight::outside;
        inside +=
            i < bounds && middle - reach > axis.low + tolerance && middle + reach < axis.high - tolerance;
        if (inside == bounds)
            return Sight::inside;
    }
    return Sight::crossing;
}

double Frustum::ownNearest(Vec3d low, Vec3d high) const {
    Vec3d half = (high - low) * 0.5;
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis)
        reach += std::abs(view_.forward[axis]) * half[axis];
    return std::max(dot(low + half, view_.forward) - reach, 0.0);
}

double Frustum::nearestDistance(const BoxD& box, Sight sight) const {
    Vec3d low = box.min - view_.eye, high = box.max - view_.eye;
    if (sight == Sight::inside)
        return ownNearest(low, high);
    if (box.contains(view_.eye))
        return 0;
    double nearest = HUGE_VAL;
    for (int face = 0; face < 6; ++face) {
        SpacePolygon part = faceOf(low, high, face / 2, face % 2);
        for (std::size_t side = 0; side < sides && part.count > 0; ++side)
            part = clipped(part, axes_[side].direction);
        for (std::size_t i = 0; i < part.count; ++i)
            nearest = std::min(nearest, dot(part.corners[i], view_.forward));
    }
    return nearest < HUGE_VAL ? std::max(nearest, 0.0) : ownNearest(low, high);
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
