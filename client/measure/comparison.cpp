#include "client/measure/comparison.hpp"

#include "client/measure/flip.hpp"
#include "client/measure/ssim.hpp"
#include "shared/base/text.hpp"

#include <algorithm>

namespace stipple::measure {
namespace {

Status comparable(const DepthImage& a, const DepthImage& b) {
    std::size_t pixels = a.image.rgba.size() / 4;
    if (a.image.width != b.image.width || a.image.height != b.image.height ||
        b.image.rgba.size() / 4 != pixels || a.distances.size() != pixels || b.distances.size() != pixels)
        return Error{ErrorCode::invalidArgument,
                     cat("a picture of ", b.image.width, " × ", b.image.height,
                         " pixels can't be compared with one of ", a.image.width, " × ", a.image.height),
                     "", "draw both in one size"};
    if (std::min(a.image.width, a.image.height) < ssimWindow)
        return Error{
            ErrorCode::invalidArgument,
            cat("pictures of ", a.image.width, " × ", a.image.height, " pixels are too small to compare"), "",
            cat("each side needs ", ssimWindow, " pixels")};
    return {};
}

} // namespace

Result<Comparison> compare(const DepthImage& reference, const DepthImage& picture) {
    STIPPLE_CHECK(comparable(reference, picture));
    Comparison result;
    result.pixels = pixelError(reference.image, picture.image);
    result.ssim = ssim(reference.image, picture.image);
    result.flipErrors = flip(reference.image, picture.image);
    result.flip = mean(result.flipErrors);
    result.depth = depthError(reference.distances, picture.distances);
    return result;
}

Image differencePicture(const Image& reference, const Image& picture) {
    Image image = reference;
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        if (i % 4 != 3)
            image.rgba[i] = static_cast<std::uint8_t>(
                std::clamp(128 + 2 * (int(picture.rgba[i]) - int(reference.rgba[i])), 0, 255));
    return image;
}

} // namespace stipple::measure
