// What both rasterizers derive from a frame plan: computed once, in double, rounded once to the floats and
// integers that the vertex shader and the software kernel use alike. It is here that "the same picture"
// is made: the rules below hold, in integers, on both sides.
//
// Window coordinates follow OpenGL: x right, y up, pixel (i, j) is the square [i, i+1) × [j, j+1).
//
// Position   r = float(p - cell) - fraction            grid steps from the camera, per axis
//            d = r · rowD                              view distance, world units
//            (x, y) = (r · rowX, r · rowY) / d + centre    pixels; orthographic: without "/ d"
//            then snapped to the middle of its 1/128-pixel cell: X = 2 floor(128 x) + 1, in 1/256 pixel.
//            This moves a point by at most 1/256 pixel and survives the sub-pixel grid of a GPU (1/256).
// Deep nodes in orthographic views, whose r is long against the picture: floats tell x to whole pixels at
// best, so x and y
//            are taken modulo 2^(32 - F) pixels in integers that wrap, F bits of them fraction:
//              s = p - cell = 2^16 high + low, -2^15 <= low < 2^15         per axis
//              X = originX + Σ low · lowX + high · highX  mod 2^32         lowX = rowX · 2^F, highX = rowX ·
//              2^(F + 16)
//            and the float x says which multiple is meant. Off by at most 6 · 2^15 · 2^-(F + 1) pixels: 0.006
//            for F = 24, which goes with nodes that reach 2^29 pixels away; F falls by one for each doubling
//            beyond.
// Size       in whole 1/64 pixels, so half a size is even in 1/256 pixel and, X being odd, no pixel centre
//            ever lies on the edge of a point: coverage needs no tie rule.
// Detail     continuous (client/core/continuous_detail.hpp): the point of rank i in its node has
//              q = (rankBase + rankStep · i) · d² / p²       orthographic: without "d²"
//              p = max(1 - falloff · |(x, y) - centre| / centre, least density)          "/" per axis
//            and is drawn where q < 1, with (1 - q) · growth of its size, at most all of it and at least a
//            pixel.
// Adaptive   sizes come from the spacing of the finest drawn node where the point lies, k levels below its
// own
//            (drawn_octree.hpp): size64 = clamp(nodeSize64 · 2^-k / d + 0.5)     orthographic: without "/ d"
// Growing    the same walk while nodes are awaited (FramePlan::awaited), where sizes don't come from
// elsewhere:
//              size64 = clamp(nodeSize64 · 2^-k / d, size64, size64 · 2^g)      orthographic: without "/ d"
//            with g awaited levels below that node, at most maxDoublings: as wide as the points are apart
//            there, until more come
// Coverage   a pixel is covered if its centre lies inside the square or circle; the pixel that holds the
//            point is covered always, so that no point vanishes between pixel centres.
// Colour     DrawNode::colourWords(); points whose word has no alpha are hidden (DrawNode::shows).
// Depth      step q = (bits(d) - bits(near)) >> depthShift, where bits() reads the float as an integer: a
//            piecewise linear logarithm, monotone, without rounding, under 2^24. The depth buffer holds
//            q / 2^24. The nearer step wins; among equal steps the point that comes first in drawOrder().
//            The logarithm of frame_plan.hpp is this one made smooth; eye-dome lighting takes it from q.
// Paraboloid circles whose pixels are farther than their point: by radius · r² / R² (see "Splats"), r and R
// in 1/256
//            pixel, at most far; in the step's d again. Points of a single pixel are flat.
// Discs      points with a normal cover, instead, the pixels whose view ray meets the plane through the
//            point, perpendicular to the normal, within the radius, as far as they lie within 127.5 pixels
//            of the point; each has the plane's view distance, brought into near..far. The pixel that holds
//            the point is covered all the same: where it misses the disc, at the point's own distance. In
//            disc.hpp. Points without a normal are circles, those of a single pixel flat.
// Splats     the nearest points are drawn first. Then each pixel's colour is the mean of the points that
// cover it and
//            whose blended step is not beyond the nearest one's, weighted by w = (1 - r² / R²)^hardness from
//            its centre's distance r from the point, where R is half the size: floor(65535 max(w, 0)) + 1.
//            With d of the point's step, the blended step is that of
//              d - (radius + factor · d), at least near      radius = size64 · radiusScale · d; orthographic:
//                                                            without "d"
//            Discs: r and R are of the disc, d is of the pixel, but in (radius + factor · d).
// Expansion  delayed: each point is a single pixel first, that of its place, and the nearest of each pixel
// stays. These
//            are then drawn with their sizes and exact places; among equal steps the one comes first whose
//            pixel does, from left to right, rows from the bottom.
#pragma once

#include "client/core/frame_plan.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace stipple {

inline constexpr int positionCells = 128; // cells a pixel, per axis
inline constexpr int sizeSteps = 64;      // size steps a pixel
inline constexpr int depthBits = 24;
inline constexpr int maxPointPixels = 255; // any larger maximum size is clamped to this
inline constexpr int maxDoublings = 2;     // "Growing"; larger points hide more of the picture than they fill
// Floats still tell a place at the edge of such a picture to about a hundredth of a pixel.
inline constexpr int maxPictureSide = 65000;
inline constexpr int maxPartSide = 16384; // of what is drawn at once
// Positions are clamped to this before they become integers; no size reaches back from there.
inline constexpr float positionLimit = 65536;

static_assert(positionLimit - maxPointPixels > maxPictureSide);
// Floats tell 1/128-pixel cells apart up to there, and integers hold them in 1/256 pixel.
static_assert(positionLimit * positionCells < 0x1p24f);
// Squared distances inside a point, in 1/256 pixel, fit 32 bits: 2 × (255 / 2 × 256)² < 2^31.
static_assert(2.0 * (maxPointPixels * 128.0) * (maxPointPixels * 128.0) < 2147483648.0);

inline std::uint32_t floatBits(float value) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}
inline float floatOfBits(std::uint32_t bits) {
    float value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

struct RasterFrame {
    // What is drawn of the picture, and the first of its pixels there: window coordinates are those of the
    // whole picture.
    int width = 0, height = 0, left = 0, bottom = 0;
    bool perspective = true;
    float centreX = 0, centreY = 0; // half the whole picture
    float near = 0, far = 0;
    std::uint32_t nearBits = 0;
    int depthShift = 0;
    bool sizeByDistance = false; // size64 = clamp(worldSize64 / d); else size64 holds for all points
    int size64 = 64;             // 1/64 pixel, clamped
    float worldSize64 = 0;       // 1/64 pixel at distance 1
    int minSize64 = 64, maxSize64 = 64;
    bool adaptive = false;   // see "Adaptive"; size64 does not matter
    bool growing = false;    // see "Growing"; never with adaptive or sizeByDistance
    bool circle = false;     // false where every point is a single pixel
    float radiusScale = 0;   // half the size in world units, per 1/64 pixel; at distance 1 in perspective
    bool paraboloid = false; // circle, too; never with splats
    bool disc = false;       // circle, too, which nodes without normals are drawn as
    // See disc.hpp. The camera's axes, over 32767; what a pixel spans at distance 1, and the same but in
    // orthographic views 0.
    std::array<float, 3> discRight{}, discUp{}, discForward{};
    float pixelUnits = 0, pixelSlope = 0;
    bool splats = false; // see "Splats"
    int hardness = 1;
    float blendFactor = 0;
    bool continuous = false; // continuous detail, see "Detail"
    float growth = 0;
    float falloffX = 0, falloffY = 0,
          leastDensity = 1;     // p = max(1 - |(x - centreX) falloffX, …|, leastDensity)
    bool sizeByDensity = false; // continuous, size64 / p: a multiple of the target spacing
};

struct RasterNode {
    std::array<float, 3> rowX{}, rowY{}, rowD{}, fraction{};
    std::array<std::int32_t, 3> cell{};
    int positionShift = 0;
    // Positions by integers, see "Deep nodes"; F = fractionBits.
    bool deep = false;
    int fractionBits = 24;
    std::array<std::uint32_t, 3> lowX{}, highX{}, lowY{}, highY{};
    std::uint32_t originX = 0, originY = 0;
    float rankBase = 0, rankStep = 0; // see "Detail"
    float nodeSize64 = 0;             // see "Adaptive"; 1/64 pixel, at distance 1 in perspective
};

// Whether points can be of different sizes.
inline bool sizesDiffer(const RasterFrame& frame) {
    return frame.sizeByDistance || frame.sizeByDensity || frame.adaptive || frame.growing;
}
// Whether sizes need the octree of the drawn nodes.
inline bool walksOctree(const RasterFrame& frame) {
    return frame.adaptive || frame.growing;
}

// The view distance at which a depth step begins.
inline float distanceOfStep(const RasterFrame& frame, std::uint32_t step) {
    return floatOfBits((step << frame.depthShift) + frame.nearBits);
}

// See "Paraboloid": the view distance of a point and how much farther a pixel is by the square of its
// distance from it in 1/256 pixel.
struct Bend {
    float distance, perSquare;
};
inline Bend bendOf(const RasterFrame& frame, std::uint32_t step, int size64) {
    float distance = distanceOfStep(frame, step);
    float radius = static_cast<float>(size64) * frame.radiusScale, half = static_cast<float>(2 * size64);
    radius = frame.perspective ? radius * distance : radius;
    return {distance, size64 > sizeSteps ? radius / (half * half) : 0.0f};
}
inline std::uint32_t bentStep(const RasterFrame& frame, const Bend& bend, int away) {
    float distance = bend.distance + bend.perSquare * static_cast<float>(away);
    return (floatBits(distance < frame.far ? distance : frame.far) - frame.nearBits) >> frame.depthShift;
}

// See "Splats". Of a point of that size and view distance.
inline float blendDepth(const RasterFrame& frame, float distance, int size64) {
    float radius = static_cast<float>(size64) * frame.radiusScale;
    radius = frame.perspective ? radius * distance : radius;
    return radius + frame.blendFactor * distance;
}
// At a distance, with the blend depth of its point.
inline std::uint32_t blendedStep(const RasterFrame& frame, float distance, float depth) {
    float back = distance - depth;
    return (floatBits(back > frame.near ? back : frame.near) - frame.nearBits) >> frame.depthShift;
}

// From how many points per pixel of the picture on delayed expansion pays, in a rasterizer: measured
// (docs/MEASUREMENTS.md).
struct ExpansionCosts {
    double pointsPerPixel = 0, pointsPerPixelSplats = 0;
};
// Whether the plan's points are to be expanded late. Never where all are single pixels.
bool expandsLate(const FramePlan& plan, const RasterFrame& frame, const ExpansionCosts& costs);
// The frame with points of a pixel each.
RasterFrame singlePixelFrame(const RasterFrame& frame);

// What is drawn of the plan's picture.
PictureWindow drawnWindow(const FramePlan& plan);
// Whether both sides of the picture are in 1..maxPictureSide, and what is drawn lies in it and is at most
// `mostSide` long.
bool isDrawable(const FramePlan& plan, int mostSide);

// The plan must be drawable.
RasterFrame rasterFrame(const FramePlan& plan);
RasterNode rasterNode(const FramePlan& plan, const DrawNode& node);

// Indices of plan.nodes that have points to draw: near to far by the node's centre, then by key, then by
// id. Empty prefixes are left out.
std::vector<std::size_t> drawOrder(const FramePlan& plan);

// Eye-dome lighting (Potree thesis §4.4, eq. 4.5 and 4.6). With P the product over the neighbours of
// max(1, distance / neighbour distance), response = log2(P) / n and
//   shade = exp(-response × 300 × strength) = exp2(-log2(P) × power).
// Neighbours that are empty or outside the picture count as 1; empty pixels keep the background.
struct EdlSetup {
    bool enabled = false; // false too where the strength makes it a pass that changes nothing
    int neighbours = 0;   // 4 or 8
    std::array<std::array<int, 2>, 8> offsets{}; // pixels, y up; none is (0, 0)
    float power = 0;
};
inline constexpr float edlProductLimit = 1e30f; // shade is 0 long before
EdlSetup edlSetup(const EyeDomeLighting& style);

} // namespace stipple
