#include "client/measure/flip_filters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stipple::measure {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double featureDegrees = 0.082; // from peak to trough of the edge filter: two standard deviations

// `weight` of -reach..reach.
template <class Weight>
std::vector<double> sampled(int reach, const Weight& weight) {
    std::vector<double> values;
    for (int x = -reach; x <= reach; ++x)
        values.push_back(weight(x));
    return values;
}

double sumOf(const std::vector<double>& values, double sign) {
    double sum = 0;
    for (double value : values)
        sum += std::max(0.0, sign * value);
    return sum;
}

// Positive weights scaled to 1 together, negative ones to -1.
Kernel normalised(const std::vector<double>& values) {
    double above = sumOf(values, 1), below = sumOf(values, -1);
    Kernel kernel;
    for (double value : values)
        kernel.push_back(static_cast<float>(value / (value < 0 ? below : above)));
    return kernel;
}

} // namespace

std::vector<GaussianTerm> sensitivityFilter(const Sensitivity& s, double pixelsPerDegree) {
    // All three channels have the window of the widest Gaussian: three standard deviations √(b / 2π²).
    double widest = std::max({achromatic.b1, redGreen.b1, blueYellow.b1, blueYellow.b2});
    int reach = static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixelsPerDegree));
    std::vector<GaussianTerm> terms;
    double total = 0;
    for (auto [a, b] : {std::pair{s.a1, s.b1}, std::pair{s.a2, s.b2}}) {
        if (a == 0)
            continue;
        std::vector<double> values = sampled(reach, [&](int x) {
            double degrees = x / pixelsPerDegree;
            return std::exp(-pi * pi * degrees * degrees / b);
        });
        double along = sumOf(values, 1), weight = a * std::sqrt(pi / b) * along * along;
        terms.push_back({static_cast<float>(weight), normalised(values)});
        total += weight;
    }
    for (GaussianTerm& term : terms)
        term.weight = static_cast<float>(term.weight / total);
    return terms;
}

FeatureFilter featureFilter(double pixelsPerDegree) {
    double deviation = 0.5 * featureDegrees * pixelsPerDegree;
    int reach = static_cast<int>(std::ceil(3 * deviation));
    auto gaussian = [&](int x) { return std::exp(-x * x / (2 * deviation * deviation)); };
    FeatureFilter filter;
    filter.gaussian = normalised(sampled(reach, gaussian));
    filter.edge = normalised(sampled(reach, [&](int x) { return -x * gaussian(x); }));
    filter.point = normalised(
        sampled(reach, [&](int x) { return (x * x / (deviation * deviation) - 1) * gaussian(x); }));
    return filter;
}

} // namespace stipple::measure
