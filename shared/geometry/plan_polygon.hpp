// Polygons as a map shows them: corners in a plane, the last joined with the first.
#pragma once

#include "shared/base/result.hpp"
#include "shared/geometry/point2d.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace stipple {

using PlanPolygon = std::span<const Point2d>;

// Is p in the triangle (corners counter-clockwise), its edges included? Exact.
bool triangleHolds(Point2d a, Point2d b, Point2d c, Point2d p);

// Do two edges meet anywhere but in the corner that neighbours share? By exact orientation tests of all
// pairs.
bool crossesItself(PlanPolygon corners);

// > 0: counter-clockwise.
double signedArea(PlanPolygon corners);

// What is left of the polygon within left <= x <= right, bottom <= y <= top (Sutherland and Hodgman,
// "Reentrant Polygon Clipping", 1974). Its signed area is that of what both hold, also of polygons that are
// not convex: parts of it may be joined by edges without width.
std::vector<Point2d> clipToBox(PlanPolygon corners, Point2d lowest, Point2d highest);

using Triangle = std::array<std::size_t, 3>; // indices of corners, counter-clockwise

// By cutting off ears (Meisters, "Polygons Have Ears", 1975), each time the one whose new edge is shortest;
// O(n²) exact orientation tests at worst. Corners in either sense; those on a
// straight edge are allowed, and belong to no triangle of their own. Errors: invalidArgument for no area, or
// edges that cross.
Result<std::vector<Triangle>> triangulate(PlanPolygon corners);

} // namespace stipple
