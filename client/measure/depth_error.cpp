#include "client/measure/depth_error.hpp"

#include <cmath>

namespace stipple::measure {
namespace {

double share(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

} // namespace

DepthError depthError(std::span<const float> reference, std::span<const float> picture, double tolerance) {
    DepthError error;
    std::uint64_t both = 0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
        bool expected = reference[i] > 0, shown = picture[i] > 0;
        error.referencePixels += expected;
        error.picturePixels += shown;
        error.holes += expected && !shown;
        error.extra += shown && !expected;
        if (expected && shown) {
            ++both;
            double apart = std::abs(double{picture[i]} - double{reference[i]});
            error.wrong += apart > tolerance * double{reference[i]};
        }
    }
    error.wrongShare = share(error.wrong, both);
    error.holeShare = share(error.holes, error.referencePixels);
    error.extraShare = share(error.extra, reference.size() - error.referencePixels);
    return error;
}

} // namespace stipple::measure
