#include "client/core/view_fit.hpp"

#include <algorithm>
#include <cmath>

namespace stipple {

namespace {

// Halves an interval of the content's size down to the resolution of a double.
constexpr int halvings = 60;

// The farthest forward that an eye may stand, sideways wherever it likes, to see all points between the two
// planes of `slope` along `axis`. Each point p demands p - eye <= slope × (p.z - eye.z) and the same
// mirrored; the two demands that bind most, added, leave out where the eye is sideways.
double eyeDepthFor(std::span<const Vec3d> points, int axis, double slope) {
    double upper = -HUGE_VAL, lower = -HUGE_VAL;
    for (Vec3d p : points) {
        upper = std::max(upper, p[axis] - slope * p.z);
        lower = std::max(lower, -p[axis] - slope * p.z);
    }
    return -(upper + lower) / (2 * slope);
}

// The place along `axis` from where the points reach as far to one side of the picture as to the other. Both
// ends of the picture fall as the eye goes up, so halving finds it.
double centredPlace(std::span<const Vec3d> points, int axis, double eyeDepth) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (Vec3d p : points) {
        low = std::min(low, p[axis]);
        high = std::max(high, p[axis]);
    }
    for (int i = 0; i < halvings; ++i) {
        double middle = low + (high - low) / 2;
        double least = HUGE_VAL, most = -HUGE_VAL;
        for (Vec3d p : points) {
            double slope = (p[axis] - middle) / (p.z - eyeDepth);
            least = std::min(least, slope);
            most = std::max(most, slope);
        }
        if (least + most == 0)
            return middle;
        (least + most > 0 ? low : high) = middle;
    }
    return low + (high - low) / 2;
}

} // namespace

Vec3d fittedEye(std::span<const Vec3d> points, double slopeX, double slopeY, double gap) {
    double nearest = HUGE_VAL;
    for (Vec3d p : points)
        nearest = std::min(nearest, p.z);
    double depth = std::min({eyeDepthFor(points, 0, slopeX), eyeDepthFor(points, 1, slopeY), nearest - gap});
    return {centredPlace(points, 0, depth), centredPlace(points, 1, depth), depth};
}

} // namespace stipple
