// A disc seen from the camera (raster_setup.hpp, "Discs"): one plane met by the rays of many pixels. The same
// operations in the same order are in sprite.glsl (discOf, discReach) and points.frag.glsl (meetDisc).
//
// In camera axes (right, up, forward) and pixels at the point's view distance d, where a pixel spans k world
// units and, in perspective, s of slope (k = s · d; orthographic: s = 0):
//
//   point      (rx, ry, 1) · d         rx, ry: slopes of its ray; 0 in orthographic views
//   ray        of the pixel (x, y) away from the point: slopes (rx + x s, ry + y s); orthographic: moved
//   normal n   of any length, turned so that c = n · (rx, ry, 1) > 0: towards away from the eye
//   e = n · (x, y, 0),  w = c + e s    the ray meets the plane where w > 0, in front
//   offset     (c x - e rx, c y - e ry, -e) / w      from the point to where it does, in pixels of k
//   inside     |offset| <= R           R: half the size, pixels; without a division: both sides times w
//   distance   d - e k / w
//
// With n, so do c, e and w have any length, which cancels. What is squared is of the size of the disc in
// pixels, whatever the world's units.
#pragma once

#include "client/core/node_normals.hpp"
#include "client/render/raster_setup.hpp"

#include <algorithm>
#include <cmath>

namespace stipple {

// How far from its point a disc reaches at most, in pixels: where it is seen nearly along its plane, close
// before the eye, it would not end.
inline constexpr float mostDiscReach = maxPointPixels * 0.5f;
// Of a normal of length 1/√3..1 and the point's ray: a disc that is turned away more than that is thinner
// than 0.003 pixels, and is drawn as the pixel that holds its point. So are
// points of a single pixel.
inline constexpr float leastDiscFacing = 1e-5f;

struct Disc {
    float rx = 0, ry = 0, facing = 1, radius = 0;        // c, R
    float leanX = 0, leanY = 0, distance = 0, units = 0; // of n; d, k
    float reachX = 0, reachY = 0;                        // no covered pixel is farther, pixels
};

// Where the ray of a pixel meets a disc.
struct DiscSpot {
    bool inside = false;
    float away = 0;     // square of its distance from the point over that of the radius: 0..1 inside
    float distance = 0; // of view; outside: the point's
};

// The axes of the ellipse that contains the disc's outline: bounds, to a hundredth of a pixel; never too
// small.
inline void setReach(const RasterFrame& frame, float nz, float lengthSquared, Disc& disc) {
    float inverse = 1.0f / lengthSquared, tilt = std::max(1.0f - nz * nz * inverse, 0.0f);
    // The nearest part of the disc, as a share of d.
    float nearest = 1.0f - disc.radius * frame.pixelSlope * std::sqrt(tilt + 1e-5f);
    float grows = 1.0f / std::max(nearest, 1e-6f);
    auto reach = [&](float lean, float slope) {
        float along = lean - nz * slope, whole = 1.0f + slope * slope;
        float across = std::max(whole - along * along * inverse, 0.0f) + 1e-5f * whole;
        return std::min(disc.radius * std::sqrt(across) * grows + 0.015625f, mostDiscReach);
    };
    disc.reachX = reach(disc.leanX, disc.rx);
    disc.reachY = reach(disc.leanY, disc.ry);
}

// x, y: of the point in 1/256 pixel from the lower left corner; step: its depth; `word`: its normal.
inline Disc discOf(const RasterFrame& frame, int x, int y, int size64, std::uint32_t step,
                   std::uint32_t word) {
    Disc disc;
    disc.distance = distanceOfStep(frame, step);
    disc.units = frame.perspective ? frame.pixelUnits * disc.distance : frame.pixelUnits;
    disc.radius = static_cast<float>(size64) * (0.5f / sizeSteps);
    disc.rx = (static_cast<float>(x) * (1.0f / 256) - frame.centreX) * frame.pixelSlope;
    disc.ry = (static_cast<float>(y) * (1.0f / 256) - frame.centreY) * frame.pixelSlope;
    float nx = 0, ny = 0, nz = 1;
    if (word != noNormalWord) {
        const Vec3<std::int32_t> whole = normalOfWord(word);
        const float a = static_cast<float>(whole.x), b = static_cast<float>(whole.y),
                    c = static_cast<float>(whole.z);
        auto along = [&](const std::array<float, 3>& axis) {
            return (a * axis[0] + b * axis[1]) + c * axis[2];
        };
        nx = along(frame.discRight);
        ny = along(frame.discUp);
        nz = along(frame.discForward);
    }
    float facing = size64 > sizeSteps ? (nx * disc.rx + ny * disc.ry) + nz : 0.0f; // single pixels are flat
    if (facing < 0) {
        nx = -nx;
        ny = -ny;
        nz = -nz;
        facing = -facing;
    }
    if (!(facing > leastDiscFacing)) {
        disc.radius = 0;
        disc.facing = 1;
        return disc;
    }
    disc.facing = facing;
    disc.leanX = nx;
    disc.leanY = ny;
    setReach(frame, nz, (nx * nx + ny * ny) + nz * nz, disc);
    return disc;
}

// across, up: from the point to the pixel's centre in 1/256 pixel.
inline DiscSpot meetDisc(const RasterFrame& frame, const Disc& disc, int across, int up) {
    const float x = static_cast<float>(across) * (1.0f / 256), y = static_cast<float>(up) * (1.0f / 256);
    const float e = disc.leanX * x + disc.leanY * y;
    const float w = disc.facing + e * frame.pixelSlope;
    const float alongX = disc.facing * x - e * disc.rx, alongY = disc.facing * y - e * disc.ry;
    const float square = (alongX * alongX + alongY * alongY) + e * e;
    const float reach = disc.radius * w;
    DiscSpot spot;
    spot.distance = disc.distance;
    spot.inside = (w > 0) & (square <= reach * reach);
    if (!spot.inside)
        return spot;
    spot.away = square * (1.0f / (reach * reach));
    const float plane = disc.distance - (e * disc.units) * (1.0f / w);
    spot.distance = std::min(std::max(plane, frame.near), frame.far);
    return spot;
}

inline std::uint32_t stepOf(const RasterFrame& frame, float distance) {
    return (floatBits(distance) - frame.nearBits) >> frame.depthShift;
}

} // namespace stipple
