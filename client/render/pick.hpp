// What a pointer points at: the point that the pixel nearest to it shows. Both rasterizers answer the same
// question over the picture that they draw, with their own coverage and depth: SoftwareRenderer::pick,
// GlesRenderer::startPick. Only nodes that can reach the pixels near the pointer are drawn.
//
// The answer names a node of the plan and the index of a point in its progressive order, which is the point's
// identity; client/core/picked_point.hpp makes the exact coordinates of it.
#pragma once

#include "client/render/raster_setup.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace stipple {

inline constexpr int maxPickRadius = 64; // pixels; larger ones are taken as this

struct PickRequest {
    double x = 0, y = 0; // of the pointer, pixels from the left and from the top of the picture
    int radius = 8;      // a pixel whose centre is farther away is not looked at, but for the pointer's own
};

struct PickHit {
    std::shared_ptr<const ResidentNode> node;
    std::uint32_t cloud = 0; // DrawNode::cloud
    std::uint32_t point = 0; // index in the node's progressive order
    double pixelsAway = 0;   // from the pointer to the centre of the pixel that shows the point
    double distance = 0;     // view distance, world units, to the resolution of a depth step
};

// An answer: no hit where nothing near enough shows a point.
struct PickAnswer {
    std::optional<PickHit> hit;
};

// What has to be drawn for an answer; stands on its own, also when the plan is gone.
struct PickTarget {
    PickRequest request;
    PictureWindow window; // the pixels that are looked at; empty if none is near enough
    // Where the centres are of all points that can cover a pixel of the window.
    PictureWindow centres;
    RasterFrame frame;
    // Indices of plan.nodes, in draw order, that can cover a pixel of the window: all others are left out for
    // certain, also by the largest size that the style allows.
    std::vector<std::size_t> order;
    std::vector<DrawNode> nodes; // those, parallel to `order`
};
PickTarget pickTarget(const FramePlan& plan, const PickRequest& request);

// A pixel of the window that shows a point.
struct PickSample {
    int column = 0, row = 0; // of the picture; rows from the bottom
    std::uint32_t step = 0;  // depth step
    std::size_t node = 0;    // index of PickTarget::nodes
    std::uint32_t point = 0;
};

// The sample nearest to the pointer; of several as near, the one nearest in depth, then first in draw order.
std::optional<PickHit> nearestHit(const PickTarget& target, std::span<const PickSample> samples);

} // namespace stipple
