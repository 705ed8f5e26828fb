#include "client/core/continuous_detail.hpp"

#include <algorithm>
#include <cmath>

namespace stipple {

double focalPixels(const ViewTransform& view, int height) {
    double halfHeight = view.projection == Projection::perspective ? view.tanHalfFovY : view.halfHeight;
    return height / (2 * halfHeight);
}

double pixelWorld(const ViewTransform& view, int height, double distance) {
    bool perspective = view.projection == Projection::perspective;
    return (perspective ? distance : 1.0) / focalPixels(view, height);
}

double reachPixels(const RankDensity& density, double pixelWorld) {
    return 1 / (std::sqrt(density.base) * pixelWorld);
}

std::uint32_t detailPrefix(const RankDensity& density, std::uint32_t points, double target) {
    double least = target * (1 - 1e-5); // the rasterizers compare in float
    double ranks = std::ceil((1 / (least * least) - density.base) / density.step);
    return static_cast<std::uint32_t>(std::clamp(ranks, 0.0, static_cast<double>(points)));
}

} // namespace stipple
