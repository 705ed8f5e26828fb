// A picture: rows from top to bottom, four bytes a pixel (R, G, B, A; A is always 255).
#pragma once

#include <cstdint>
#include <vector>

namespace stipple {

struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba; // 4 × width × height
};

// A picture and how far away what it shows is: view distances, rows from top to bottom, 0 where there is no
// point.
struct DepthImage {
    Image image;
    std::vector<float> distances; // width × height
};

} // namespace stipple
