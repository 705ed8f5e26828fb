#include "client/measure/ssim.hpp"

#include "client/measure/plane.hpp"

#include <cmath>
#include <utility>

namespace stipple::measure {
namespace {

constexpr double sigma = 1.5;
constexpr double c1 = (0.01 * 255) * (0.01 * 255), c2 = (0.03 * 255) * (0.03 * 255);

Plane<double> lumaOf(const Image& image) {
    Plane<double> luma(image.width, image.height);
    for (std::size_t i = 0; i < luma.values.size(); ++i) {
        const std::uint8_t* p = image.rgba.data() + 4 * i;
        luma.values[i] = 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2];
    }
    return luma;
}

std::vector<double> gaussian() {
    std::vector<double> weights;
    double sum = 0;
    for (int x = -ssimWindow / 2; x <= ssimWindow / 2; ++x)
        sum += weights.emplace_back(std::exp(-x * x / (2 * sigma * sigma)));
    for (double& weight : weights)
        weight /= sum;
    return weights;
}

Plane<double> product(const Plane<double>& a, const Plane<double>& b) {
    Plane<double> result = a;
    for (std::size_t i = 0; i < result.values.size(); ++i)
        result.values[i] *= b.values[i];
    return result;
}

} // namespace

double ssim(const Image& reference, const Image& picture) {
    const std::vector<double> window = gaussian();
    auto weighted = [&](const Plane<double>& plane) { return filtered(plane, window, window); };
    Plane<double> x = lumaOf(reference), y = lumaOf(picture);
    Plane<double> meanX = weighted(x), meanY = weighted(y);
    Plane<double> xx = weighted(product(x, x)), yy = weighted(product(y, y)), xy = weighted(product(x, y));

    double sum = 0;
    constexpr int margin = ssimWindow / 2;
    for (int row = margin; row < x.height - margin; ++row)
        for (int column = margin; column < x.width - margin; ++column) {
            double mx = meanX.row(row)[column], my = meanY.row(row)[column];
            double varianceX = xx.row(row)[column] - mx * mx, varianceY = yy.row(row)[column] - my * my;
            double covariance = xy.row(row)[column] - mx * my;
            sum += (2 * mx * my + c1) * (2 * covariance + c2) /
                   ((mx * mx + my * my + c1) * (varianceX + varianceY + c2));
        }
    return sum / (static_cast<double>(x.width - 2 * margin) * (x.height - 2 * margin));
}

} // namespace stipple::measure
