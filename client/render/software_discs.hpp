// Which pixels a disc covers (disc.hpp), for the loops of the software renderer.
#pragma once

#include "client/render/disc.hpp"
#include "client/render/software_coverage.hpp"

namespace stipple {

// visit(cell, where its ray meets the disc) for all pixels that the disc at (x, y) covers, 1/256 pixel,
// clipped to what is drawn. Cells: of that, rows from top to bottom; y goes up.
template <class Visit>
STIPPLE_INLINE void visitDisc(const RasterFrame& frame, const Disc& disc, int x, int y, const Visit& visit) {
    // Even, as `x` and `y` are odd; the pixel that holds the point is always among them.
    auto half = [](float reach) { return std::max(static_cast<int>(reach * 256) & ~1, 128); };
    const int halfX = half(disc.reachX), halfY = half(disc.reachY);
    const int top = frame.bottom + frame.height - 1;
    const int firstRow = std::max(firstCovered(y, halfY), frame.bottom);
    const int lastRow = std::min(lastCovered(y, halfY), top);
    const int first = std::max(firstCovered(x, halfX), frame.left);
    const int last = std::min(lastCovered(x, halfX), frame.left + frame.width - 1);
    for (int row = firstRow; row <= lastRow; ++row) {
        const int up = row * 256 + 128 - y;
        const std::size_t line = static_cast<std::size_t>(top - row) * static_cast<std::size_t>(frame.width);
        for (int column = first; column <= last; ++column) {
            const int across = column * 256 + 128 - x;
            const DiscSpot spot = meetDisc(frame, disc, across, up);
            const bool holdsPoint = std::max(std::abs(across), std::abs(up)) < 128;
            if (spot.inside || holdsPoint)
                visit(line + static_cast<std::size_t>(column - frame.left), spot);
        }
    }
}

} // namespace stipple
