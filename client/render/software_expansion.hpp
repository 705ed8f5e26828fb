// Delayed expansion in the software renderer (raster_setup.hpp, "Expansion"): from the nearest point of each
// pixel, drawn as single pixels, to the points in their sizes.
#pragma once

#include "client/render/software_shading.hpp"
#include "client/render/software_splats.hpp"

#include <cstdint>
#include <vector>

namespace stipple {

// What there is to expand: the cells of the points as single pixels, and whose points they are.
struct Centres {
    const std::vector<PlacedNode>* nodes = nullptr;
    const std::uint32_t* octree = nullptr; // drawn_octree.hpp, adaptive sizes only
    const std::uint64_t* cells = nullptr;
};

// Draws the points whose centres are in `rows` into `cells`, as drawRun() does, their index being that of the
// pixel of their centre: from left to right, rows from the bottom.
struct RowRange {
    int first = 0, end = 0; // from the top
};
void expandRows(const RasterFrame& frame, const Centres& centres, RowRange rows, std::uint64_t* cells,
                bool shared);
// Blends them, as blendRun() does; `nearest` is what expandRows() drew.
void blendExpandedRows(const RasterFrame& frame, const Centres& centres, RowRange rows,
                       const std::uint64_t* nearest, PixelSums* sums);

// Puts the points' own indices into row `y` of `cells`.
void nameExpandedRow(const RasterFrame& frame, const Centres& centres, int y, std::uint64_t* cells);

} // namespace stipple
