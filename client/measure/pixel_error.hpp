// How far two pictures of one size are apart, pixel by pixel. Levels are 0..255; alpha does not count.
//
// Checked: closed forms (constant, complementary and single-pixel differences), symmetry, identity.
#pragma once

#include "client/render/image.hpp"

#include <cstdint>

namespace stipple::measure {

struct PixelError {
    // UnityPIC §5, eq. 6: the mean over all pixels of |baseline - picture|. There pictures have one channel;
    // here it is the mean of the three, which is the same for grey pictures. Levels; 25.5 are "10 %".
    double mean = 0;
    double rms = 0;              // levels: root of the mean square, over pixels and channels
    int largest = 0;             // levels, any channel
    std::uint64_t differing = 0; // pixels with a channel further apart than `tolerance`
};

// Both pictures have one size and at least one pixel.
PixelError pixelError(const Image& reference, const Image& picture, int tolerance = 8);

} // namespace stipple::measure
