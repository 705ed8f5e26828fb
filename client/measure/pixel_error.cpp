#include "client/measure/pixel_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace stipple::measure {

PixelError pixelError(const Image& reference, const Image& picture, int tolerance) {
    std::uint64_t sum = 0, squares = 0, differing = 0;
    int largest = 0;
    for (std::size_t at = 0; at < reference.rgba.size(); at += 4) {
        int worst = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            int apart = std::abs(int(reference.rgba[at + c]) - int(picture.rgba[at + c]));
            worst = std::max(worst, apart);
            sum += static_cast<std::uint64_t>(apart);
            squares += static_cast<std::uint64_t>(apart * apart);
        }
        largest = std::max(largest, worst);
        differing += worst > tolerance;
    }
    auto pixels = static_cast<double>(reference.rgba.size() / 4);
    return {static_cast<double>(sum) / (3 * pixels), std::sqrt(static_cast<double>(squares) / (3 * pixels)),
            largest, differing};
}

} // namespace stipple::measure
