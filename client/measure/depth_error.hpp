// Whether a picture shows the surfaces that it should: by the view distances of its pixels, rows from the
// top, 0 where there is no point.
//
// Checked: hand-made pictures with every kind of pixel.
#pragma once

#include <cstdint>
#include <span>

namespace stipple::measure {

// A pixel shows another surface if its distance differs by more than this part of the reference's. A
// hundredth is the step between two points of a surface seen at a grazing angle, not that between two
// surfaces.
inline constexpr double depthTolerance = 0.01;

struct DepthError {
    std::uint64_t referencePixels = 0; // that the reference covers
    std::uint64_t picturePixels = 0;   // that the picture covers
    std::uint64_t wrong = 0;           // both cover it, at distances that differ by more than the tolerance
    std::uint64_t holes = 0;           // the reference covers it, the picture doesn't
    std::uint64_t extra = 0;           // the picture covers it, the reference doesn't
    double wrongShare = 0;             // of the pixels that both cover; 0 if there are none
    double holeShare = 0;              // of the pixels that the reference covers
    double extraShare = 0;             // of the pixels that the reference leaves empty
};

// Both of one length.
DepthError depthError(std::span<const float> reference, std::span<const float> picture,
                      double tolerance = depthTolerance);

} // namespace stipple::measure
