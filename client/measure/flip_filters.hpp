// The filters of FLIP (flip.hpp) for a number of pixels a degree; each is a product of one along rows and one
// along columns, or a sum of two such.
#pragma once

#include <vector>

namespace stipple::measure {

using Kernel = std::vector<float>; // odd number of weights

// Contrast sensitivity (table 1): a1 √(π/b1) exp(-π² d² / b1) + the same of a2, b2, over distances d in
// degrees.
struct Sensitivity {
    double a1, b1, a2, b2;
};
inline constexpr Sensitivity achromatic{1, 0.0047, 0, 1e-5};
inline constexpr Sensitivity redGreen{1, 0.0053, 0, 1e-5};
inline constexpr Sensitivity blueYellow{34.1, 0.04, 13.5, 0.025};

// weight × (kernel along rows × kernel along columns), summed; all weights together are 1.
struct GaussianTerm {
    float weight;
    Kernel kernel; // sums to 1
};
std::vector<GaussianTerm> sensitivityFilter(const Sensitivity& sensitivity, double pixelsPerDegree);

struct FeatureFilter {
    Kernel gaussian; // sums to 1
    Kernel edge;     // first derivative: positive weights sum to 1, negative ones to -1
    Kernel point;    // second derivative, likewise
};
FeatureFilter featureFilter(double pixelsPerDegree);

} // namespace stipple::measure
