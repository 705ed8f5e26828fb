// The geometry pass of the software renderer: points into cells. A cell is the nearest point of a pixel,
//
//   q << 39 | index      q: depth step (raster_setup.hpp), index: place of the point in draw order
//
// so the smaller cell wins, ties go to the point that comes first, and what a picture holds does not depend
// on which thread came when. Colours are looked up afterwards, for visible points only.
#pragma once

#include "client/render/raster_setup.hpp"
#include "client/render/software_transform.hpp"

#include <cstdint>

namespace stipple {

inline constexpr int indexBits = 39;
inline constexpr std::uint64_t indexMask = (std::uint64_t{1} << indexBits) - 1;
// No point. Every point is smaller, and all cells are positive as signed numbers.
inline constexpr std::uint64_t emptyCell = ~std::uint64_t{0} >> 1;
static_assert(indexBits + depthBits == 63);

// A run of points of one node.
struct PointRun {
    const ResidentNode* node = nullptr;
    const RasterNode* raster = nullptr;
    std::uint32_t first = 0, count = 0;
    std::uint64_t index = 0; // of point `first` in draw order
    const std::uint32_t* octree =
        nullptr; // drawn_octree.hpp, and the node's place in it: adaptive sizes only
    std::uint32_t place = 0;
    const std::uint32_t* hiding = nullptr;  // colour words of the node's points, if some are hidden
    const std::uint32_t* normals = nullptr; // words of the node's points (node_normals.hpp), for discs
};

// Where points `done` to `done` + `count` of a run lie; count <= blockPoints.
void fillBlock(const RasterFrame& frame, const PointRun& run, std::size_t done, std::size_t count,
               Sizing sizing, Block& block);

// Draws a run into `cells`: width × height, rows from top to bottom, and one more that must be 0 (points
// outside the picture go there and never win). With `shared`, other threads may be drawing too.
void drawRun(const RasterFrame& frame, const PointRun& run, std::uint64_t* cells, bool shared);
// The same of a block whose points have indices of their own; `normals`: theirs, or null.
void placeListed(const RasterFrame& frame, const Block& block, std::size_t count, Sizing sizing,
                 const std::uint32_t* indices, const std::uint32_t* normals, std::uint64_t* cells,
                 bool shared);

} // namespace stipple
