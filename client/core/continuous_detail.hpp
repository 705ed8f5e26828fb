// Continuous level of detail (Schütz, Krösl, Wimmer 2019, §3), streamed: which points of a node a picture
// needs, and how large each has grown.
//
// The paper gives each point a random fraction of a level; here the place in the node's progressive order is
// that fraction, so that what is drawn of a node is always a prefix of it, and neither fetched nor sent to
// the rasterizer beyond. A surface has four times the points at half the spacing, and a node at level L adds
// the three quarters that its ancestors lack. With S the node's spacing and n its points in the file,
//
//   rank r < n has the level   L - 1 + log4(1 + 3 (r + 1/2) / n)       and the spacing 2 S / sqrt(1 + 3 (r +
//   1/2) / n),
//
// from 2 S, which is where the parent ends, to S. The root has no ancestors: its first r points are all there
// are, so its spacings are S / sqrt((r + 1/2) / n). Either way 1 / spacing² is linear in r:  base + step · r
// (rank_density.hpp, also of leaves, which may hold more points than S says).
//
// A point is drawn where its spacing exceeds the target, which is `spacingPixels` on the screen (eq. 2 with
// CLOD = 1000 spacingPixels / focal length in pixels; so a zoomed or orthographic view counts as what it
// shows). With q = (target / spacing)², it has grown to (1 - q) / (1 - (1 - growthRange)²) of its size, at
// most 1: from nothing where the target is its spacing to all of it where the target is (1 - growthRange) of
// that (§3.2.3).
#pragma once

#include "client/core/frame_plan.hpp"
#include "client/core/rank_density.hpp"

#include <cstdint>

namespace stipple {

// Pixels that a world unit takes at distance 1 in perspective, anywhere in orthographic views.
double focalPixels(const ViewTransform& view, int height);

// World units that a pixel spans at a view distance.
double pixelWorld(const ViewTransform& view, int height, double distance);

// The first point's spacing in pixels of so many world units. A node whose reach, where it is nearest, is no
// larger than the target has nothing to show; its descendants' reaches are no larger.
double reachPixels(const RankDensity& density, double pixelWorld);

// How many points of `points`, from the first on, have a spacing of more than `target` world units: the only
// ones that can show where the target is nowhere less.
std::uint32_t detailPrefix(const RankDensity& density, std::uint32_t points, double target);

} // namespace stipple
