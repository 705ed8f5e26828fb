#include "client/core/expected_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stipple {
namespace {

constexpr std::size_t lanes = 8;

// Sum over a row of slopes. Lanes of their own, so that the compiler may take several at a time.
float rowSum(const float* slopes, std::size_t count, float density, float rest, float most) {
    std::array<float, lanes> sums{};
    for (std::size_t c = 0; c < count; c += lanes)
        for (std::size_t l = 0; l < lanes; ++l) {
            float points = slopes[c + l] * density - rest;
            points = points > 0 ? points : 0;
            sums[l] += points < most ? points : most;
        }
    float sum = 0;
    for (float lane : sums)
        sum += lane;
    return sum;
}

} // namespace

bool ExpectedPoints::isInPicture(Vec3d fromEye) const {
    double depth = dot(fromEye, view_.forward);
    double half = view_.projection == Projection::perspective ? view_.tanHalfFovY * depth : view_.halfHeight;
    return depth >= view_.near && std::abs(dot(fromEye, view_.right)) <= half * view_.aspect &&
           std::abs(dot(fromEye, view_.up)) <= half;
}

float ExpectedPoints::slopeAt(Vec3d fromEye, double step) const {
    if (!isInPicture(fromEye))
        return 0;
    double pixel = pixelWorld(view_, height_, dot(fromEye, view_.forward));
    return static_cast<float>(1 / (pixel * pixel * step));
}

void ExpectedPoints::add(const BoxD& box, const RankDensity& density, std::uint32_t points) {
    Vec3d step = (box.max - box.min) * (1.0 / cellsAcross);
    Vec3d first = box.min - view_.eye + step * 0.5;
    std::size_t row = slopes_.size();
    slopes_.resize(row + stride);
    for (std::size_t cell = 0; cell < cells; ++cell) {
        Vec3d place{static_cast<double>(cell % cellsAcross),
                    static_cast<double>(cell / cellsAcross % cellsAcross),
                    static_cast<double>(cell / (cellsAcross * cellsAcross))};
        Vec3d at = first + Vec3d{place.x * step.x, place.y * step.y, place.z * step.z};
        slopes_[row + cell] = slopeAt(at, density.step);
    }
    rests_.push_back(static_cast<float>(density.base / density.step));
    most_.push_back(static_cast<float>(points));
}

double ExpectedPoints::shownAt(double target) const {
    auto density = static_cast<float>(1 / (target * target));
    double sum = 0;
    for (std::size_t i = 0; i < most_.size(); ++i)
        sum += double{rowSum(slopes_.data() + i * stride, stride, density, rests_[i], most_[i])};
    return sum / cells;
}

double ExpectedPoints::shownOf(std::size_t index, double target, std::uint32_t points) const {
    float most = std::min(most_[index], static_cast<float>(points));
    return double{rowSum(slopes_.data() + index * stride, stride, static_cast<float>(1 / (target * target)),
                         rests_[index], most)} /
           cells;
}

} // namespace stipple
