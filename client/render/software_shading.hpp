// The full-screen passes of the software renderer, by rows: colours of the visible points, and eye-dome
// lighting.
#pragma once

#include "client/render/image.hpp"
#include "client/render/raster_setup.hpp"
#include "client/render/software_points.hpp"

#include <cstdint>
#include <vector>

namespace stipple {

// The nodes of a frame in draw order.
struct PlacedNode {
    const DrawNode* draw = nullptr;
    RasterNode raster;
    std::uint64_t firstIndex = 0;  // of its first point in draw order
    std::uint32_t octreePlace = 0; // DrawnOctree::places, with adaptive sizes
};

// Of point `point` of a node: R | G << 8 | B << 16 | 255 << 24.
std::uint32_t colourOf(const DrawNode& node, std::size_t point);

// 1 / view distance per pixel and 0 where there is no point, with a margin of zeros around the picture as
// wide as the neighbours of eye-dome lighting reach.
struct InverseDistances {
    int margin = 0;
    std::size_t stride = 0;
    std::vector<float> values;

    void resize(int width, int height, const EdlSetup& edl);
    float* row(int y) { return values.data() + (static_cast<std::size_t>(y + margin)) * stride + margin; }
    const float* row(int y) const {
        return values.data() + (static_cast<std::size_t>(y + margin)) * stride + margin;
    }
};

// Row `y` (from the top) of the picture from its cells; `distances` is filled too unless it is nullptr.
void colourRow(const FramePlan& plan, const RasterFrame& frame, const std::vector<PlacedNode>& nodes,
               const std::uint64_t* cells, int y, Image& image, InverseDistances* distances);

// Shades row `y`. Rows are independent of each other.
void shadeRow(const EdlSetup& edl, const InverseDistances& distances, int y, Image& image);

} // namespace stipple
