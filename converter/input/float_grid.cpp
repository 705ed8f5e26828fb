#include "converter/input/float_grid.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace stipple {

namespace {
constexpr int float32Bits = 24;
constexpr double mostSteps = 68719476736.0;            // 2^36
constexpr double mostFloat32Steps = 2147483648.0;      // 2^31
constexpr double mostForcedSteps = 4503599627370496.0; // 2^52: the widest root cube
constexpr double mostFromZero = 9007199254740992.0;    // 2^53
constexpr double finestStep = 1e-30;                   // of numbers so small that they are all but zero
constexpr double largestInteger = 2147483647.0;        // that LAS can count to
constexpr double offsetSteps = 1e6;     // offsets are multiples of so many steps: short decimals
constexpr double finestOfExtent = 1e-9; // of numbers with more digits than a scanner measures

// The double nearest to 10^exponent, which prints as just that.
double powerOfTen(int exponent) {
    return std::strtod(cat("1e", exponent).c_str(), nullptr);
}

double largestExtent(const BoxD& bounds) {
    double extent = 0;
    for (int axis = 0; axis < 3; ++axis)
        extent = std::max(extent, bounds.max[axis] - bounds.min[axis]);
    return extent;
}

double largestMagnitude(const BoxD& bounds) {
    double magnitude = 0;
    for (int axis = 0; axis < 3; ++axis)
        magnitude = std::max({magnitude, std::abs(bounds.min[axis]), std::abs(bounds.max[axis])});
    return magnitude;
}

int stepExponent(const BoxD& bounds, const Precision& precision) {
    if (precision.decimals >= 0)
        return -precision.decimals;
    double magnitude = largestMagnitude(bounds);
    if (magnitude == 0)
        return -3;
    double half = std::max(std::ldexp(1.0, std::ilogb(magnitude) - precision.significandBits), finestStep);
    int exponent = static_cast<int>(std::floor(std::log10(half)));
    double extent = largestExtent(bounds);
    if (precision.significandBits > float32Bits && extent > 0)
        exponent = std::max(
            exponent, static_cast<int>(std::ceil(std::log10(std::max(extent * finestOfExtent, finestStep)))));
    return exponent;
}
} // namespace

Grid floatGrid(const BoxD& bounds, const Precision& precision, double step) {
    Grid grid;
    if (bounds.empty())
        return grid;
    double extent = largestExtent(bounds), magnitude = largestMagnitude(bounds);
    if (step <= 0) {
        int exponent = stepExponent(bounds, precision);
        const double most = precision.significandBits > float32Bits ? mostSteps : mostFloat32Steps;
        while (extent / powerOfTen(exponent) > most || magnitude / powerOfTen(exponent) > mostFromZero)
            ++exponent;
        step = powerOfTen(exponent);
    }
    while (extent / step > mostForcedSteps || magnitude / step > mostFromZero)
        step *= 10;
    grid.scale = {step, step, step};
    for (int axis = 0; axis < 3; ++axis) {
        double largest = std::max(std::abs(bounds.min[axis]), std::abs(bounds.max[axis]));
        if (largest / step <= largestInteger)
            continue;
        double unit = step * offsetSteps;
        double centre = bounds.min[axis] / 2 + bounds.max[axis] / 2;
        // Through text: the product may be off in its last digit, and nobody wants to read that digit.
        char text[40];
        std::snprintf(text, sizeof text, "%.15g", std::round(centre / unit) * unit);
        grid.offset[axis] = std::strtod(text, nullptr);
    }
    return grid;
}

} // namespace stipple
