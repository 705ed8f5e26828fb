// The grid of an input whose coordinates are floating-point numbers.
#pragma once

#include "shared/geometry/box.hpp"
#include "shared/geometry/grid.hpp"

namespace stipple {

// How exactly coordinates are stated.
struct Precision {
    int decimals = -1; // digits after the point, where they are decimals; -1: binary numbers
    // Of binary numbers, also of those that were written as decimals: 24 (float32) or 53 (float64).
    int significandBits = 53;
};

// Coordinates farther out than this are no places: they are left out and counted as out of range. A thousand
// times the earth's size in micrometres is still within.
inline constexpr double largestCoordinate = 1e12;

// The step is the same on all axes and a power of ten. Decimals: 10^-decimals, so that every coordinate is
// exact. Binary numbers: the largest power of ten that is at most half of the spacing of such numbers at the
// largest |coordinate|, and at least 10^-9 of the extent (a float64 has digits that no scanner measured).
// In both cases coarser where the extent would else exceed 2^36 steps, or 2^31 of float32: nodes wider than
// 2^31 steps can hold no points (docs/ARCHITECTURE.md), so such a cloud would have no coarse picture, for
// digits that are noise.
// `step` > 0 overrides, coarser by powers of ten where the extent would exceed 2^52 steps. In each case the
// largest |coordinate| is at most 2^53 steps, as world coordinates are doubles. Offsets are multiples of the
// step, near the box's centre where integers would else exceed 31 bits, and 0 otherwise. Does not depend on
// anything but its arguments.
Grid floatGrid(const BoxD& bounds, const Precision& precision, double step = 0);

} // namespace stipple
