// Everything a rasterizer needs to draw one frame, and nothing else: no hierarchy, no loading, no I/O.
// Both rasterizers (client/render) draw the same plan and must give the same picture within the tolerance
// that tests state.
//
// Positions are camera-relative in integers (design: "Camera-relative, in integers"). For each node:
//
//   p        in-node integer of the point (ResidentNode)
//   cell     cameraCell: the camera's position in steps from the node's minimum corner, rounded down
//   fraction cameraFraction: what rounding left, in [0, 1) per axis
//   relative = (float(p - cell) - fraction) * scale        world units, seen from the camera
//
// p - cell is exact in 32-bit integers. Where the camera is so far away that `cell` would not fit 30 bits,
// the plan raises `coarseShift`: p and cell are in units of 2^coarseShift steps and `scale` is multiplied
// to match; what p loses by this is under 2^-29 of the distance.
//
// Depth: a point at view distance d (along `forward`) in [near, far] has depth log2(d / near) /
// log2(far / near) in [0, 1]. Points nearer than near or beyond far are not drawn.
#pragma once

#include "client/core/counters.hpp"
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
};

struct DrawNode {
    std::shared_ptr<const ResidentNode> node;
    std::uint32_t pointCount = 0;             // draw this prefix; <= node->pointCount
    std::array<std::int32_t, 3> cameraCell{}; // see above; |cell| < 2^30
    std::array<float, 3> cameraFraction{};    // [0, 1)
    Vec3d scale;                              // world units per integer (after coarseShift)
    int coarseShift = 0;                      // low bits of p that are dropped; 0 nearly always
    double cameraZ = 0; // world z of the camera, for elevation: z = cameraZ + relative.z
    double spacing = 0; // minimum distance of the node's points, world units
};

struct FramePlan {
    int width = 0, height = 0; // pixels
    ViewTransform view;
    Style style;                 // ranges are resolved: min < max where the mode needs one
    std::vector<DrawNode> nodes; // near to far or any order; the picture does not depend on it
    FrameCounters counters;      // the renderer adds passesRun and passesSkipped
};

} // namespace stipple
