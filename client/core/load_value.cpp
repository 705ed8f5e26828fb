#include "client/core/load_value.hpp"

#include "client/core/continuous_detail.hpp"

#include <algorithm>
#include <cmath>

namespace stipple {

namespace {

constexpr int cellsAcross = 3, cells = 27;

bool isInPicture(const ViewTransform& view, Vec3d fromEye) {
    double depth = dot(fromEye, view.forward);
    double half = view.projection == Projection::perspective ? view.tanHalfFovY * depth : view.halfHeight;
    return depth >= view.near && std::abs(dot(fromEye, view.right)) <= half * view.aspect &&
           std::abs(dot(fromEye, view.up)) <= half;
}

// Of what lies there: 1 at the near plane.
double partInSight(const ViewTransform& view, const BoxD& box) {
    Vec3d middle = box.min + (box.max - box.min) * 0.5 - view.eye;
    double nearest = length(middle) - length(box.max - box.min) * 0.5;
    return std::sqrt(view.near / std::max(nearest, view.near));
}

} // namespace

double loadValue(const ViewTransform& view, int height, const Hierarchy& hierarchy, std::size_t node,
                 std::uint32_t from, std::uint32_t to) {
    RankDensity density = hierarchy.densityOf(node);
    density.base += density.step * from;
    const BoxD& box = hierarchy.node(node).geometry.box;
    Vec3d step = (box.max - box.min) * (1.0 / cellsAcross);
    Vec3d first = box.min - view.eye + step * 0.5;
    auto areaAt = [&](Vec3d fromEye) {
        double pixels = reachPixels(density, pixelWorld(view, height, dot(fromEye, view.forward)));
        return pixels * pixels;
    };
    double area = 0;
    for (int cell = 0; cell < cells; ++cell) {
        Vec3d at = first + Vec3d{step.x * (cell % cellsAcross), step.y * (cell / cellsAcross % cellsAcross),
                                 step.z * (cell / (cellsAcross * cellsAcross))};
        if (isInPicture(view, at))
            area += areaAt(at);
    }
    if (area == 0) { // a little of it is in view all the same
        Vec3d middle = first + step;
        double depth = std::max(dot(middle, view.forward), view.near);
        area = areaAt(view.forward * depth) / 2;
    }
    return area / cells * (to - from) * partInSight(view, box);
}

} // namespace stipple
