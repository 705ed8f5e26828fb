// Points as clouds have them, on integer grids, and the way from one to another without the rounding of world
// coordinates: at UTM, ECEF or offsets of 10^9 a world coordinate has lost what a small distance is made of.
#pragma once

#include "shared/geometry/grid.hpp"

#include <span>
#include <vector>

namespace stipple::survey {

struct GridPoint {
    Vec3i steps; // |steps| <= 2^53
    Grid grid;   // of the point's cloud
};

// World units, rounded once an axis: relative error at most 2^-52 of each coordinate, also between clouds of
// different grids.
Vec3d difference(const GridPoint& to, const GridPoint& from);

// All as seen from the first: what every measure here takes. Empty for none.
std::vector<Vec3d> localPoints(std::span<const GridPoint> points);

} // namespace stipple::survey
