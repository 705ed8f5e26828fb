// Parts of a picture: drawn one after another, they are, bit for bit, the picture drawn in one piece
// (FramePlan::part). What reaches into a part from outside is drawn with it, in a margin that is cut off.
#pragma once

#include "client/render/raster_setup.hpp"

#include <cstddef>
#include <vector>

namespace stipple {

// How far from the pixels that it covers a point's centre can be; a pixel more covers all rounding.
double pointReach(const RasterFrame& frame);

// So many pixels more on each side, as far as the picture goes.
PictureWindow grownBy(const PictureWindow& window, int pixels, const FramePlan& plan);

// What has to be drawn for the pixels of `kept` to be those of the whole picture: with the points that reach
// into it, and what eye-dome lighting looks at.
PictureWindow withMargin(const PictureWindow& kept, const FramePlan& plan);
// Its width and height are at most those of `kept` and twice this.
inline constexpr int maxPartMargin = maxPointPixels / 2 + 2 + 64;

// Indices of plan.nodes, in draw order, that can cover a pixel of the window: all others are left out for
// certain, also by the largest size that the style allows.
std::vector<std::size_t> nodesIn(const FramePlan& plan, const RasterFrame& frame,
                                 const PictureWindow& window);

// What of the plan is drawn for its part, in draw order.
std::vector<std::size_t> partOrder(const FramePlan& plan, const RasterFrame& frame);
// Adds the others to plan.counters.nodesOutsidePart.
void countOutside(FramePlan& plan, const std::vector<std::size_t>& order);

// The picture in parts of at most `width` × `height` pixels: from left to right, rows of them from the top.
// Parts of a row have the same height.
std::vector<PictureWindow> partsOf(const FramePlan& plan, int width, int height);

} // namespace stipple
