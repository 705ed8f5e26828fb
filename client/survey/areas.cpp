#include "client/survey/areas.hpp"

#include "client/survey/lines.hpp"
#include "client/survey/symmetric_matrix.hpp"
#include "shared/geometry/accurate_sum.hpp"
#include "shared/geometry/plan_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace stipple::survey {

namespace {

// Half the sum of corner × next corner: its length is the largest area of any projection, its part along a
// direction the area seen from there.
Vec3d vectorArea(std::span<const Vec3d> corners) {
    AccurateSum x, y, z;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        // From the first corner, so that where it lies costs no digits.
        Vec3d a = corners[i] - corners[0], b = corners[(i + 1) % corners.size()] - corners[0];
        x.addProduct(a.y, b.z);
        x.addProduct(-a.z, b.y);
        y.addProduct(a.z, b.x);
        y.addProduct(-a.x, b.z);
        z.addProduct(a.x, b.y);
        z.addProduct(-a.y, b.x);
    }
    return {0.5 * x.value(), 0.5 * y.value(), 0.5 * z.value()};
}

} // namespace

Plane bestFitPlane(std::span<const Vec3d> points, const Directions& directions) {
    Vec3d mean;
    for (Vec3d point : points)
        mean = mean + point * (1 / static_cast<double>(points.size()));
    SymmetricMatrix spread;
    for (Vec3d point : points)
        spread.addSquare(point - mean);
    Eigenvectors axes = eigenvectors(spread);
    Vec3d normal = axes.vectors[0];
    if (axes.values[1] <= 1e-24 * axes.values[2]) { // on a line: any plane through it fits
        Vec3d line = axes.vectors[2];
        Vec3d across = cross(directions.up, line);
        normal =
            axes.values[2] > 0 && length(across) > 1e-9 ? normalized(cross(line, across)) : directions.up;
        if (axes.values[2] > 0 && length(across) <= 1e-9) // upright
            normal = directions.north;
    }
    return {mean, dot(normal, directions.up) < 0 ? normal * -1.0 : normal};
}

Area measureArea(std::span<const Vec3d> corners, const Directions& directions) {
    Area area;
    if (corners.empty())
        return area;
    area.plane = bestFitPlane(corners, directions);
    area.perimeter = measureLine(corners, directions, true).distance;
    if (corners.size() < 3)
        return area;
    Vec3d vector = vectorArea(corners);
    area.horizontal = std::abs(dot(vector, directions.up));
    area.inPlane = std::abs(dot(vector, area.plane.normal));
    for (Vec3d corner : corners)
        area.deviation = std::max(area.deviation, std::abs(dot(corner - area.plane.at, area.plane.normal)));
    std::vector<Point2d> plan;
    for (Vec3d corner : corners)
        plan.push_back(directions.plan(corner));
    area.crosses = crossesItself(plan);
    return area;
}

} // namespace stipple::survey
