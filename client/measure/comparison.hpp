// Every measure of error between a picture and its reference, at once.
#pragma once

#include "client/measure/depth_error.hpp"
#include "client/measure/pixel_error.hpp"
#include "client/measure/plane.hpp"
#include "client/render/image.hpp"
#include "shared/base/result.hpp"

#include <vector>

namespace stipple::measure {

// A picture and how far away what it shows is: view distances, rows from the top, 0 where there is no point.
struct DepthPicture {
    Image image;
    std::vector<float> distances;
};

struct Comparison {
    PixelError pixels;
    double ssim = 1;
    double flip = 0;
    DepthError depth;
    Plane<float> flipErrors; // what flip is the mean of
};

// Errors: invalidArgument if the sizes differ or a side is shorter than ssimWindow (ssim.hpp).
Result<Comparison> compare(const DepthPicture& reference, const DepthPicture& picture);

// Mid grey where both are equal, twice the difference of each channel around it.
Image differencePicture(const Image& reference, const Image& picture);

} // namespace stipple::measure
