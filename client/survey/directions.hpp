// What is up, and what is north, where people measure. In projected coordinates these are the axes z and y;
// in geocentric ones (ECEF, EPSG method 9602) they depend on the place.
#pragma once

#include "shared/geometry/point2d.hpp"
#include "shared/geometry/vec3.hpp"

namespace stipple::survey {

// Unit vectors, perpendicular to each other.
struct Directions {
    Vec3d up{0, 0, 1}, north{0, 1, 0};

    Vec3d east() const { return cross(north, up); }
    double height(Vec3d local) const { return dot(local, up); }
    Point2d plan(Vec3d local) const { return {dot(local, east()), dot(local, north)}; } // east, north
};

struct Ellipsoid {
    double semiMajor = 6378137.0, inverseFlattening = 298.257223563; // WGS 84
};

// At a geocentric place, not at the Earth's centre: up is the ellipsoid's normal (not the line from the
// centre), north the meridian's direction; at a pole north is along the axis x. To 1e-15 radian.
Directions geocentricDirections(Vec3d place, const Ellipsoid& ellipsoid = {});

} // namespace stipple::survey
