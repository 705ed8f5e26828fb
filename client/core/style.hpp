// How points look. Plain values; the page, `--style` JSON and golden scenes set the same fields.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace stipple {

enum class ColourMode : std::uint8_t { rgb, intensity, elevation };
enum class PointSizeMode : std::uint8_t { fixed, world };
enum class PointShape : std::uint8_t { square, circle };
enum class GradientName : std::uint8_t { viridis, turbo, inferno, spectral, grey, terrain };

struct Range {
    double min = 0, max = 0; // min == max: taken from the cloud's statistics
    friend bool operator==(const Range&, const Range&) = default;
};

struct EyeDomeLighting {
    bool enabled = true;
    int neighbours = 8;        // 4 or 8
    double radiusPixels = 1.4; // distance of the neighbours
    double strength = 0.4;     // 0 = none
    friend bool operator==(const EyeDomeLighting&, const EyeDomeLighting&) = default;
};

struct Style {
    ColourMode colourMode = ColourMode::rgb;
    GradientName gradient = GradientName::viridis; // of intensity and elevation
    Range intensityRange;                          // raw intensity
    Range elevationRange;                          // world units
    PointSizeMode sizeMode = PointSizeMode::fixed;
    double sizePixels = 2;  // diameter, fixed mode
    double sizeWorld = 0.1; // diameter in world units, world mode
    double minSizePixels = 1, maxSizePixels = 64;
    PointShape shape = PointShape::circle;
    EyeDomeLighting edl;
    std::array<std::uint8_t, 3> background{24, 26, 30};
    friend bool operator==(const Style&, const Style&) = default;
};

} // namespace stipple
