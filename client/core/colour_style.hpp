// What of a style says how points are coloured and which of them are hidden. Plain values; names and ranges
// are as in JSON (client/core/colour_json.hpp), defaults show every point in its own colour.
#pragma once

#include "shared/geometry/oriented_box.hpp"
#include "shared/geometry/vec3.hpp"
#include "shared/select/region_shape.hpp"

#include <array>
#include <bitset>
#include <cstdint>
#include <string>
#include <vector>

namespace stipple {

enum class ColourMode : std::uint8_t {
    rgb,
    intensity,
    elevation,
    classification,  // shared/points/point_classes.hpp
    returnNumber,    // this and what follows: along the gradient
    numberOfReturns, //
    pointSourceId,
    gpsTime,
    level,     // of the octree; continuous detail: of the point (client/core/continuous_detail.hpp)
    attribute, // any, by name
    mix,       // several of them
};
enum class GradientName : std::uint8_t { viridis, turbo, inferno, spectral, grey, terrain };

struct Range {
    double min = 0, max = 0; // min == max: taken from the cloud's statistics
    friend bool operator==(const Range&, const Range&) = default;
};

// One of the colours of ColourMode::mix.
struct MixedColour {
    ColourMode mode = ColourMode::rgb; // any but mix
    std::string attribute;             // of mode attribute
    Range range;                       // of what goes along the gradient
    double weight = 1;                 // > 0; a colour counts weight / sum of the weights
    friend bool operator==(const MixedColour&, const MixedColour&) = default;
};

// Points whose value lies outside a range are hidden. Ranges are closed and of what values mean (scaled
// attributes: offset + scale × stored), as in the server's `where`; "no value" and NaN are in none. A cloud
// without the attribute shows all its points.
struct AttributeFilter {
    std::string attribute;
    double min = 0, max = 0; // infinite where open
    friend bool operator==(const AttributeFilter&, const AttributeFilter&) = default;
};

enum class ClipMode : std::uint8_t { highlight, hideInside, hideOutside };

// A box, turned in any way; closed. A point is where its grid puts it in double (Grid::toWorld), and lies in
// the box or not exactly (shared/geometry/oriented_box.hpp).
struct ClipBox {
    Vec3d centre;
    Vec3d halfSize;                                  // along the box's own axes, world units, >= 0
    BoxAxes axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; // orthonormal
    ClipMode mode = ClipMode::hideOutside;
    friend bool operator==(const ClipBox&, const ClipBox&) = default;
};

// What lies along a line, in a footprint, or behind a polygon on the screen; exactly, too
// (shared/select/point_region.hpp).
struct ClipRegion {
    RegionShape shape;
    ClipMode mode = ClipMode::hideOutside;
    friend bool operator==(const ClipRegion&, const ClipRegion&) = default;
};

using ClassSet = std::bitset<256>;

struct ColourStyle {
    ColourMode colourMode = ColourMode::rgb;
    GradientName gradient = GradientName::viridis; // of all but rgb and classification
    Range intensityRange;                          // intensity
    Range elevationRange;                          // world units
    Range levelRange;                              // levels
    std::string attribute;                         // of mode attribute; one of several components: the first
    Range attributeRange; // of returnNumber, numberOfReturns, pointSourceId, gpsTime, attribute
    std::vector<MixedColour> mix;

    ClassSet hiddenClasses; // points of these classes are hidden
    std::vector<AttributeFilter> filters;
    // Hidden is what lies in one that is hideInside, and, if there are boxes or regions that are hideOutside,
    // what lies in none of them. What lies in one that is highlight is tinted.
    std::vector<ClipBox> clipBoxes;
    std::vector<ClipRegion> clipRegions;
    std::array<std::uint8_t, 3> highlight{255, 64, 0};

    friend bool operator==(const ColourStyle&, const ColourStyle&) = default;
};

inline constexpr std::size_t maxMixedColours = 16, maxAttributeFilters = 64, maxClipBoxes = 4096,
                             maxClipRegions = 256, maxClipCorners = 10'000; // corners: of all together

// The attribute that a mode shows; empty for those that show none (or several).
std::string_view attributeOf(ColourMode mode, const std::string& attribute);
// Whether the style may hide points.
bool hidesPoints(const ColourStyle& style);

} // namespace stipple
