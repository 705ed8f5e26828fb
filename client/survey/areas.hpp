// Areas of polygons that were drawn by picking: as a map shows them, and in the plane that fits them best.
// Points are local (exact_points.hpp); areas in squares of the cloud's unit.
#pragma once

#include "client/survey/directions.hpp"

#include <span>

namespace stipple::survey {

struct Plane {
    Vec3d at;     // the points' mean
    Vec3d normal; // unit; in the half-space of `up`
};

// The plane from which the sum of the squared distances of the points is least. At least one point. If they
// lie on one line, it is the plane through it that is nearest to horizontal.
Plane bestFitPlane(std::span<const Vec3d> points, const Directions& directions = {});

struct Area {
    double horizontal = 0; // in plan
    double inPlane = 0;    // in the best-fit plane
    Plane plane;           //
    double deviation = 0;  // largest distance of a corner from that plane
    double perimeter = 0;  // in space
    bool crosses = false;  // edges cross or touch in plan: the areas are sums of loops of either sense
};

// Of the polygon with these corners, the last joined with the first. Fewer than three have no area.
Area measureArea(std::span<const Vec3d> corners, const Directions& directions = {});

} // namespace stipple::survey
