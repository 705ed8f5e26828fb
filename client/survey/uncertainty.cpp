#include "client/survey/uncertainty.hpp"

#include <cmath>

namespace stipple::survey {

double deviationOfSpacing(double spacing) {
    return spacing / std::sqrt(12.0);
}

double uncertaintyOf(const Measure& measure, std::span<const Vec3d> points,
                     std::span<const double> deviations) {
    std::vector<Vec3d> moved(points.begin(), points.end());
    double variance = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) {
            moved[i][axis] = points[i][axis] + deviations[i];
            double above = measure(moved);
            moved[i][axis] = points[i][axis] - deviations[i];
            double below = measure(moved);
            moved[i][axis] = points[i][axis];
            variance += (above - below) * (above - below) / 4;
        }
    return std::sqrt(variance);
}

} // namespace stipple::survey
