// The grid of an input whose coordinates are floating-point numbers.
#pragma once

#include "shared/geometry/box.hpp"
#include "shared/geometry/grid.hpp"

namespace stipple {

// How exactly coordinates are stated.
struct Precision {
    int decimals = -1;        // digits after the point, where they are decimals; -1: binary numbers
    int significandBits = 53; // of binary numbers: 24 (float32) or 53 (float64)
};

// The step is the same on all axes and a power of ten. Decimals: 10^-decimals, so every coordinate is exact.
// Binary numbers: the largest power of ten that is at most half of the spacing of such numbers at the largest
// |coordinate|, and at least 10^-9 of the extent (a float64 has digits that no scanner measured). `step` > 0
// overrides. In each case coarser if the extent would else exceed 2^52 steps. Offsets are multiples of the
// step, near the box's centre where integers would else exceed 31 bits, and 0 otherwise. Does not depend on
// anything but its arguments.
Grid floatGrid(const BoxD& bounds, const Precision& precision, double step = 0);

} // namespace stipple
