#include "client/measure/flip.hpp"

#include "client/core/gradients.hpp"
#include "client/measure/colour_spaces.hpp"
#include "client/measure/flip_filters.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stipple::measure {
namespace {

constexpr double colourExponent = 0.7;
constexpr double splitPart = 0.4, splitError = 0.95; // of the largest colour distance; the error given to it

using Planes = std::array<Plane<float>, 3>;

std::array<double, 256> linearLevels() {
    std::array<double, 256> linear;
    for (std::size_t level = 0; level < linear.size(); ++level)
        linear[level] = linearOfSrgb(static_cast<double>(level) / 255);
    return linear;
}

Planes ycxczPlanes(const Image& image) {
    static const std::array<double, 256> linear = linearLevels();
    Planes planes;
    planes.fill(Plane<float>(image.width, image.height));
    for (std::size_t i = 0; i < planes[0].values.size(); ++i) {
        const std::uint8_t* p = image.rgba.data() + 4 * i;
        Vec3d colour = ycxczOf(whiteRelativeOfLinear({linear[p[0]], linear[p[1]], linear[p[2]]}));
        for (int c = 0; c < 3; ++c)
            planes[static_cast<std::size_t>(c)].values[i] = static_cast<float>(colour[c]);
    }
    return planes;
}

Plane<float> seen(const Plane<float>& plane, const Sensitivity& sensitivity, double pixelsPerDegree) {
    Plane<float> sum(plane.width, plane.height);
    for (const GaussianTerm& term : sensitivityFilter(sensitivity, pixelsPerDegree)) {
        Plane<float> part = filtered(plane, term.kernel, term.kernel);
        for (std::size_t i = 0; i < sum.values.size(); ++i)
            sum.values[i] += term.weight * part.values[i];
    }
    return sum;
}

// What the eye makes of the colours, in the space where their distances are judged.
Vec3d perceived(Vec3d ycxcz) {
    Vec3d linear = linearOfWhiteRelative(whiteRelativeOfYcxcz(ycxcz));
    for (int c = 0; c < 3; ++c)
        linear[c] = std::clamp(linear[c], 0.0, 1.0);
    return huntAdjusted(labOf(whiteRelativeOfLinear(linear)));
}

double largestDistance() {
    static const double distance = hyab(huntAdjusted(labOf(whiteRelativeOfLinear({0, 1, 0}))),
                                        huntAdjusted(labOf(whiteRelativeOfLinear({0, 0, 1}))));
    return distance;
}

double colourError(double distance) {
    double largest = std::pow(largestDistance(), colourExponent), split = splitPart * largest;
    double error = std::pow(distance, colourExponent);
    return error < split ? error * splitError / split
                         : splitError + (error - split) / (largest - split) * (1 - splitError);
}

Plane<float> colourErrors(const Planes& reference, const Planes& picture, double pixelsPerDegree) {
    const std::array<Sensitivity, 3> sensitivities{achromatic, redGreen, blueYellow};
    Planes a, b;
    for (std::size_t c = 0; c < 3; ++c) {
        a[c] = seen(reference[c], sensitivities[c], pixelsPerDegree);
        b[c] = seen(picture[c], sensitivities[c], pixelsPerDegree);
    }
    Plane<float> errors(a[0].width, a[0].height);
    for (std::size_t i = 0; i < errors.values.size(); ++i) {
        auto at = [i](const Planes& p) { return Vec3d{p[0].values[i], p[1].values[i], p[2].values[i]}; };
        errors.values[i] = static_cast<float>(colourError(hyab(perceived(at(a)), perceived(at(b)))));
    }
    return errors;
}

// How strong a feature of the luminance is at each pixel: the length of its responses along rows and columns.
Plane<float> features(const Plane<float>& luminance, const Kernel& derivative, const Kernel& gaussian) {
    Plane<float> x = filtered(luminance, derivative, gaussian), y = filtered(luminance, gaussian, derivative);
    for (std::size_t i = 0; i < x.values.size(); ++i)
        x.values[i] = std::hypot(x.values[i], y.values[i]);
    return x;
}

Plane<float> normalisedLuminance(Plane<float> y) {
    for (float& value : y.values)
        value = (value + 16) / 116;
    return y;
}

Plane<float> featureErrors(const Plane<float>& reference, const Plane<float>& picture,
                           double pixelsPerDegree) {
    const FeatureFilter filter = featureFilter(pixelsPerDegree);
    Plane<float> a = normalisedLuminance(reference), b = normalisedLuminance(picture);
    Plane<float> edgesA = features(a, filter.edge, filter.gaussian),
                 edgesB = features(b, filter.edge, filter.gaussian);
    Plane<float> pointsA = features(a, filter.point, filter.gaussian),
                 pointsB = features(b, filter.point, filter.gaussian);
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        float apart = std::max(std::abs(edgesA.values[i] - edgesB.values[i]),
                               std::abs(pointsA.values[i] - pointsB.values[i]));
        a.values[i] = std::sqrt(apart / std::numbers::sqrt2_v<float>);
    }
    return a;
}

} // namespace

Plane<float> flip(const Image& reference, const Image& picture, double pixelsPerDegree) {
    Planes a = ycxczPlanes(reference), b = ycxczPlanes(picture);
    Plane<float> errors = colourErrors(a, b, pixelsPerDegree);
    Plane<float> features = featureErrors(a[0], b[0], pixelsPerDegree);
    for (std::size_t i = 0; i < errors.values.size(); ++i)
        errors.values[i] = std::pow(errors.values[i], 1 - std::min(1.0f, features.values[i]));
    return errors;
}

double mean(const Plane<float>& errors) {
    double sum = 0;
    for (float error : errors.values)
        sum += error;
    return sum / static_cast<double>(errors.values.size());
}

Image errorPicture(const Plane<float>& errors) {
    const GradientTable& table = gradientTable(GradientName::inferno);
    Image image{errors.width, errors.height, {}};
    image.rgba.reserve(4 * errors.values.size());
    for (float error : errors.values) {
        std::uint32_t word = table[static_cast<std::size_t>(
            std::lround(std::clamp(error, 0.0f, 1.0f) * static_cast<float>(gradientEntries - 1)))];
        for (int shift = 0; shift < 32; shift += 8)
            image.rgba.push_back(static_cast<std::uint8_t>(word >> shift));
    }
    return image;
}

} // namespace stipple::measure
