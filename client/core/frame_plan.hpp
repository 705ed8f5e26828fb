// Everything a rasterizer needs to draw one frame, and nothing else: no hierarchy, no loading, no I/O.
// Both rasterizers (client/render) draw the same plan and must give the same picture within the tolerance
// that tests state.
//
// Positions are camera-relative in integers (design: "Camera-relative, in integers"). For each node:
//
//   p        in-node integer of the point (ResidentNode)
//   cell     cameraCell: the camera's position in steps from the node's minimum corner, rounded down, and
//            brought to the nearest of 0..2^nodeBits (at most 2^31 - 1) where it lies outside
//   fraction cameraFraction: what is left of the position: in [0, 1) on axes where the camera is level with
//            the node, negative below it, larger above it
//   relative = (float(p - cell) - fraction) * scale        world units, seen from the camera
//
// p - cell is exact in 32-bit integers. p - cell and -fraction never differ in sign outside the node, so
// nothing cancels: the error is relative to the distance from the camera, under 0.001 pixel in perspective
// for any grid and zoom. In orthographic views that distance is the depth of the content, and float would be
// off by 2^-23 of it; where that shows, positions in the picture are integers
// (client/render/raster_setup.hpp).
//
// Depth: a point at view distance d (along `forward`) in [near, far] has depth log2(d / near) /
// log2(far / near) in [0, 1]. Points nearer than near or beyond far are not drawn.
#pragma once

#include "client/core/counters.hpp"
#include "client/core/node_normals.hpp"
#include "client/core/node_paint.hpp"
#include "client/core/rank_density.hpp"
#include "client/core/resident_node.hpp"
#include "client/core/style.hpp"
#include "shared/geometry/vec3.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace stipple {

enum class Projection : std::uint8_t { perspective, orthographic };

struct ViewTransform {
    Projection projection = Projection::perspective;
    // Unit vectors of the camera in world axes; right-handed: right × up = -forward.
    Vec3d right{1, 0, 0}, up{0, 0, 1}, forward{0, 1, 0};
    double tanHalfFovY = 0.5;      // perspective: tan of half the vertical field of view
    double halfHeight = 1;         // orthographic: half the view's height, world units
    double aspect = 1;             // width / height
    double near = 0.1, far = 1000; // view distances, world units; 0 < near < far
    // Where distances start. Perspective: the camera's position. Orthographic: that position moved along
    // `forward` (which changes no pixel) so that all content lies in front.
    Vec3d eye;

    friend bool operator==(const ViewTransform&, const ViewTransform&) = default;
};

struct DrawNode {
    std::shared_ptr<const ResidentNode> node;
    // Colours and hidden points, of all of the node's points; null: its own colour words, all of them shown.
    std::shared_ptr<const NodePaint> paint;
    std::shared_ptr<const NodeNormals> normals; // of all of the node's points; null: discs are circles
    std::uint32_t pointCount = 0;               // draw this prefix; <= node->pointCount
    std::array<std::int32_t, 3> cameraCell{};   // see above; >= 0
    std::array<float, 3> cameraFraction{};      // see above
    std::array<double, 3> cameraOffset{};       // the same, before it was rounded to float
    Vec3d scale;                                // world units per integer
    double spacing = 0;                         // minimum distance of the node's points, world units
    RankDensity density;                        // of its points by rank, for continuous detail
    std::uint32_t cloud = 0; // whose node it is (CloudId of the session); nodes of one octree have the same

    // A point each (NodePaint::words); empty: all points are plain (plainColourWord).
    const std::vector<std::uint32_t>& colourWords() const {
        return paint ? *paint->words : node->colourWords;
    }
    std::uint64_t colourId() const { return paint ? paint->id : node->id; } // of colourWords()
    // Whether the point is drawn, and may be picked.
    bool shows(std::size_t point) const { return !paint || paint->shows(point); }
};

// A node that belongs in the picture but isn't drawn yet, or that is drawn with less than a third of what its
// level adds (its place in a node's prefix is then nearer to the level above: continuous_detail.hpp).
struct AwaitedNode {
    std::uint32_t cloud = 0; // as DrawNode::cloud
    NodeKey key;
    friend bool operator==(const AwaitedNode&, const AwaitedNode&) = default;
};

// Some pixels of a picture; rows count from the bottom.
struct PictureWindow {
    int left = 0, bottom = 0, width = 0, height = 0;
    bool empty() const { return width <= 0 || height <= 0; }
    friend bool operator==(const PictureWindow&, const PictureWindow&) = default;
};

struct FramePlan {
    int width = 0, height = 0; // pixels
    // What of the picture is drawn; empty: all of it. Its pixels are those that the whole picture has there,
    // but near edges within the picture, where points and shadows from outside are missing
    // (client/render/picture_parts.hpp).
    PictureWindow part;
    ViewTransform view;
    Style style;                 // ranges are resolved: min < max where the mode needs one
    double detailPixels = 0;     // continuous detail: the target spacing in pixels; 0: draw whole prefixes
    std::vector<DrawNode> nodes; // near to far or any order; the picture does not depend on it
    std::vector<AwaitedNode> awaited;      // where points grow until they come (Style::growsWhileLoading)
    FrameCounters counters;                // the renderer adds passesRun and passesSkipped
    std::uint64_t gpuBytes = 128ull << 20; // nodes that are not in the plan stay on the GPU up to so many
};

} // namespace stipple
