// The circle through three points that were picked (a column, a tank, a bend of a road).
#pragma once

#include "shared/base/result.hpp"
#include "shared/geometry/vec3.hpp"

namespace stipple::survey {

struct Circle {
    Vec3d centre;      // local, as the points
    Vec3d normal;      // unit, of the circle's plane
    double radius = 0; // > 0
};

// Errors: invalidArgument if two points are equal or the three are on one line (the height of their triangle
// is below 1e-12 of its longest side).
Result<Circle> circleThrough(Vec3d a, Vec3d b, Vec3d c);

} // namespace stipple::survey
