#include "client/survey/exact_points.hpp"

#include "shared/geometry/exact_sum.hpp"

namespace stipple::survey {

namespace {

// steps of a × scale + offset less the same of b.
double axisDifference(const GridPoint& a, const GridPoint& b, int axis) {
    ExactSum<6> sum;
    sum.add(a.grid.offset[axis]);
    sum.add(-b.grid.offset[axis]);
    sum.addProduct(a.grid.scale[axis], static_cast<double>(a.steps[axis]));
    sum.addProduct(-b.grid.scale[axis], static_cast<double>(b.steps[axis]));
    return sum.value();
}

} // namespace

Vec3d difference(const GridPoint& to, const GridPoint& from) {
    return {axisDifference(to, from, 0), axisDifference(to, from, 1), axisDifference(to, from, 2)};
}

std::vector<Vec3d> localPoints(std::span<const GridPoint> points) {
    std::vector<Vec3d> local;
    local.reserve(points.size());
    for (const GridPoint& point : points)
        local.push_back(difference(point, points.front()));
    return local;
}

} // namespace stipple::survey
