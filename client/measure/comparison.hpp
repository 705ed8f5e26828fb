// Every measure of error between a picture and its reference, at once.
#pragma once

#include "client/measure/depth_error.hpp"
#include "client/measure/pixel_error.hpp"
#include "client/measure/plane.hpp"
#include "client/render/image.hpp"
#include "shared/base/result.hpp"

namespace stipple::measure {

struct Comparison {
    PixelError pixels;
    double ssim = 1;
    double flip = 0;
    DepthError depth;
    Plane<float> flipErrors; // what flip is the mean of
};

// Errors: invalidArgument if the sizes differ or a side is shorter than ssimWindow (ssim.hpp).
Result<Comparison> compare(const DepthImage& reference, const DepthImage& picture);

// Mid grey where both are equal, twice the difference of each channel around it.
Image differencePicture(const Image& reference, const Image& picture);

} // namespace stipple::measure
