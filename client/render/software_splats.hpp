// The blending of the software renderer (raster_setup.hpp, "Splats"): sums of weighted colours, in integers,
// so that they are the same in any order and on any number of threads.
#pragma once

#include "client/render/software_points.hpp"
#include "client/render/software_shading.hpp"

#include <cstdint>
#include <span>

namespace stipple {

// Levels × weights, and weights (at most 2^16), of up to 2^40 points.
struct alignas(32) PixelSums {
    std::uint64_t red = 0, green = 0, blue = 0, weight = 0;
};

// Adds a run of `placed` to `sums` (one per pixel) where it lies within its blend depth of what `cells` hold,
// the nearest points. One thread per array of sums.
void blendRun(const RasterFrame& frame, const PlacedNode& placed, const PointRun& run,
              const std::uint64_t* cells, PixelSums* sums);

// The same of a block of points in these colours; `normals`: theirs, or null. No size may be `single`.
void blendBlock(const RasterFrame& frame, const Block& block, std::size_t count, const std::uint32_t* colours,
                const std::uint32_t* normals, const std::uint64_t* cells, PixelSums* sums);

// Row `y` (from the top) of the picture from several arrays of sums; `distances` (from `cells`) is filled too
// unless it is nullptr.
void blendedRow(const FramePlan& plan, const RasterFrame& frame, std::span<const PixelSums* const> sums,
                const std::uint64_t* cells, int y, Image& image, InverseDistances* distances);

} // namespace stipple
