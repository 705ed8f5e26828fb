// How points look. Plain values; the page, `--style` JSON and golden scenes set the same fields.
#pragma once

#include "client/core/colour_style.hpp"

#include <array>
#include <cstdint>

namespace stipple {

// `spacing`: by the target spacing of continuous detail; `adaptive`: by the spacing of the finest drawn node
// where the point lies (Potree thesis §4.3.3).
enum class PointSizeMode : std::uint8_t { fixed, world, spacing, adaptive };
// Paraboloids are circles bent away from the camera: where they overlap, each pixel shows the point nearest
// to it, as a Voronoi diagram does (Potree thesis §4.2.3). Splats take them as circles. Discs lie in the
// plane perpendicular to the point's normal, two-sided, and have its depth (Botsch et al. 2005; Brandt et al.
// 2019, §4.2); their normals are fetched for them alone (client/core/node_normals.hpp), and points without
// are circles.
enum class PointShape : std::uint8_t { square, circle, paraboloid, disc };

struct EyeDomeLighting {
    bool enabled = true;
    int neighbours = 8;        // 4 or 8
    double radiusPixels = 1.4; // distance of the neighbours
    double strength = 0.4;     // 0 = none
    friend bool operator==(const EyeDomeLighting&, const EyeDomeLighting&) = default;
};

enum class DetailMode : std::uint8_t { discrete, continuous };

// How the density of points falls with distance: by whole nodes, or point by point
// (client/core/continuous_detail.hpp; the fields below are its alone).
struct Detail {
    DetailMode mode = DetailMode::discrete;
    double spacingPixels = 0.5; // wanted between neighbours; more where the point budget asks for it
    double growthRange =
        0.2; // 0..0.99: a point grows from nothing to full size over this part of the target spacing
    // Density at the distance dc from the picture's centre (1 at the middle of each side): max(1 -
    // peripheralFalloff · dc, peripheralDensity) of that at the centre, as a factor of the spacing (eq. 3;
    // there 0.5 and 0.3). 0: the same everywhere.
    double peripheralFalloff = 0, peripheralDensity = 0.3;
    friend bool operator==(const Detail&, const Detail&) = default;
};

// High-quality splats (Botsch et al. 2005; Potree thesis §4.2.2): what lies about as near as a pixel's
// nearest point is blended, each point by (1 - (distance from its middle / radius)²)^hardness, instead of
// showing the nearest alone. About as near: within the blend depth, radius + depthFactor × view distance
// (UnityPIC eq. 5).
struct Splats {
    bool enabled = false;
    int hardness = 2;           // 1..16; the higher, the sharper the bounds between points
    double depthFactor = 0.001; // 0..1
    friend bool operator==(const Splats&, const Splats&) = default;
};

// Points are drawn as single pixels first; then the nearest of each pixel in its size (UnityPIC §4.3.3).
// Quicker with many points, but what lies behind another point's centre is lost. `automatic`: where there are
// more points than it pays for.
enum class DelayedExpansion : std::uint8_t { off, on, automatic };

struct Style : ColourStyle {
    PointSizeMode sizeMode = PointSizeMode::fixed;
    double sizePixels = 2;  // diameter, fixed mode
    double sizeWorld = 0.1; // diameter in world units, world mode
    // Diameter in spacings, modes spacing (of the target; without continuous detail the mode is as fixed) and
    // adaptive.
    double sizeSpacings = 2;
    double minSizePixels = 1, maxSizePixels = 64;
    // Modes fixed and spacing: where finer nodes that belong in the picture are still to come, points are
    // up to twice as wide for each level that is missing there, at most four times, so that no holes show
    // until then. Never of a settled picture.
    bool growsWhileLoading = true;
    PointShape shape = PointShape::circle;
    Splats splats;
    DelayedExpansion delayedExpansion = DelayedExpansion::off;
    Detail detail;
    EyeDomeLighting edl;
    std::array<std::uint8_t, 3> background{24, 26, 30};
    friend bool operator==(const Style&, const Style&) = default;
};

} // namespace stipple
