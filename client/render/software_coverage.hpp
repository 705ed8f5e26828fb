// Which pixels a point covers (raster_setup.hpp, "Coverage"), for the loops of the software renderer.
#pragma once

#include "client/render/raster_setup.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

#define STIPPLE_INLINE inline __attribute__((always_inline))

namespace stipple {

// Where a point of half size `half` at `at` (both 1/256 pixel; `half` even, `at` odd) begins and ends along
// an axis: first and last pixel whose centre it covers. Nothing here is ever a tie.
STIPPLE_INLINE int firstCovered(int at, int half) {
    return (at - half - 128 + 255) >> 8;
}
STIPPLE_INLINE int lastCovered(int at, int half) {
    return (at + half - 128) >> 8;
}

// Half the chord of a circle at `away` from its middle, rounded down: exact in double below 2^53.
STIPPLE_INLINE int halfChord(int half, int away) {
    return static_cast<int>(std::sqrt(static_cast<double>(half * half - away * away)));
}

// visit(cell, square of the distance of the pixel's centre from the point in 1/256 pixel) for all pixels of a
// square or circle of any size, clipped to what is drawn. Cells: of that, rows from top to bottom; y goes up.
template <class Visit>
STIPPLE_INLINE void visitCovered(const RasterFrame& frame, int x, int y, int half, const Visit& visit) {
    const int bottom = frame.bottom, top = bottom + frame.height - 1;
    int firstRow = std::max(firstCovered(y, half), bottom);
    int lastRow = std::min(lastCovered(y, half), top);
    for (int row = firstRow; row <= lastRow; ++row) {
        int away = std::abs(row * 256 + 128 - y);
        int reach = frame.circle ? halfChord(half, away) : half;
        int first = firstCovered(x, reach), last = lastCovered(x, reach);
        if (away < 128) { // the pixel that holds the point
            first = std::min(first, x >> 8);
            last = std::max(last, x >> 8);
        }
        first = std::max(first, frame.left);
        last = std::min(last, frame.left + frame.width - 1);
        std::size_t line = static_cast<std::size_t>(top - row) * static_cast<std::size_t>(frame.width);
        for (int column = first; column <= last; ++column) {
            int across = column * 256 + 128 - x;
            visit(line + static_cast<std::size_t>(column - frame.left), away * away + across * across);
        }
    }
}

} // namespace stipple
