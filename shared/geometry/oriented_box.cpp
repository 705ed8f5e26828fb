#include "shared/geometry/oriented_box.hpp"

#include "shared/geometry/exact_sum.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace stipple {

BoxAxes axesTurned(double degrees) {
    double turn = std::remainder(degrees, 360.0); // exact, in [-180, 180]
    double cosine = std::cos(turn * std::numbers::pi / 180), sine = std::sin(turn * std::numbers::pi / 180);
    if (turn == 0 || std::abs(turn) == 180) {
        cosine = turn == 0 ? 1 : -1;
        sine = 0;
    } else if (std::abs(turn) == 90) {
        cosine = 0;
        sine = turn > 0 ? 1 : -1;
    }
    return {Vec3d{cosine, sine, 0}, Vec3d{-sine, cosine, 0}, Vec3d{0, 0, 1}};
}

std::optional<BoxAxes> axesOfQuaternion(double x, double y, double z, double w) {
    double largest = std::max(std::max(std::abs(x), std::abs(y)), std::max(std::abs(z), std::abs(w)));
    if (!(largest > 0) || !std::isfinite(x + y + z + w))
        return std::nullopt;
    x /= largest, y /= largest, z /= largest, w /= largest; // squares of tiny or huge numbers are none
    double s = 2 / (x * x + y * y + z * z + w * w);
    return BoxAxes{Vec3d{1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)},
                   Vec3d{s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)},
                   Vec3d{s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)}};
}

Result<ConvexRegion> orientedBox(Vec3d centre, Vec3d size, const BoxAxes& axes, bool anyHeight) {
    const int ownAxes = anyHeight ? 2 : 3;
    for (int i = 0; i < ownAxes; ++i) {
        if (!isExactlySummable(centre[i]))
            return Error{ErrorCode::invalidArgument, say("the box's centre is out of range"), "", ""};
        if (!isExactlySummable(size[i]) || size[i] < 0)
            return Error{ErrorCode::invalidArgument, say("the box's size is negative or out of range"), "",
                         ""};
    }
    std::vector<HalfSpace> sides;
    Vec3d reach;
    for (int i = 0; i < ownAxes; ++i) {
        Vec3d normal = axes[static_cast<std::size_t>(i)];
        for (int axis = 0; axis < 3; ++axis) {
            if (!isExactlySummable(normal[axis]))
                normal[axis] = 0;
            reach[axis] += std::abs(normal[axis]) * (size[i] / 2);
        }
        sides.push_back({normal, centre, size[i] / 2});
        sides.push_back({normal * -1.0, centre, size[i] / 2});
    }
    // A little wider than they are: the axes are rounded, and so is this.
    constexpr double infinity = std::numeric_limits<double>::infinity();
    BoxD bounds;
    for (int axis = 0; axis < 3; ++axis) {
        double around = reach[axis] * (1 + 0x1p-40) + (size.x + size.y + (anyHeight ? 0 : size.z)) * 0x1p-40;
        around += std::abs(centre[axis]) * 0x1p-50;
        bool endless = anyHeight && axis == 2;
        bounds.min[axis] = endless ? -infinity : centre[axis] - around;
        bounds.max[axis] = endless ? infinity : centre[axis] + around;
    }
    return ConvexRegion(std::move(sides), bounds);
}

} // namespace stipple
