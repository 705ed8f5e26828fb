#include "shared/geometry/screen_prism.hpp"

#include "shared/geometry/exact_sum.hpp"
#include "shared/geometry/plan_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace stipple {

namespace {

Error refused(Phrase what) {
    return {ErrorCode::invalidArgument, what, "", say("draw the polygon anew")};
}

bool isUsable(Vec3d v) {
    return isExactlySummable(v.x) && isExactlySummable(v.y) && isExactlySummable(v.z);
}

// Parts too small to be summed exactly are none.
Vec3d usableNormal(Vec3d v) {
    Vec3d normal = normalized(v);
    for (int axis = 0; axis < 3; ++axis)
        if (!isExactlySummable(normal[axis]))
            normal[axis] = 0;
    return normal;
}

// Where the rays meet a plane across the direction of view: right and up of it, whichever way these lie.
struct Picture {
    Vec3d right, up, forward;
    explicit Picture(Vec3d direction) : forward(normalized(direction)) {
        Vec3d other = std::abs(forward.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
        right = normalized(cross(forward, other));
        up = cross(right, forward);
    }
};

} // namespace

Result<ScreenPrism> ScreenPrism::make(const ScreenPolygon& polygon) {
    const std::vector<Vec3d>& corners = polygon.corners;
    if (corners.size() < 3 || corners.size() > maxScreenCorners)
        return refused(say("a polygon on the screen has 3 to 1000 corners"));
    bool usable = isUsable(polygon.forward) && length(polygon.forward) > 0 &&
                  std::all_of(corners.begin(), corners.end(), isUsable) &&
                  (!polygon.eye || isUsable(*polygon.eye));
    if (!usable)
        return refused(say("the polygon's numbers are out of range"));
    const Picture picture(polygon.forward);
    const Vec3d at = polygon.eye.value_or(corners.front());
    std::vector<Vec3d> rays; // from `at` to the corners
    std::vector<Point2d> plan;
    for (Vec3d corner : corners) {
        Vec3d ray = corner - at;
        double depth = dot(ray, picture.forward);
        if (polygon.eye && !(depth > 1e-9 * length(ray)))
            return refused(say("a corner of the polygon lies beside or behind the eye"));
        double scale = polygon.eye ? 1 / depth : 1;
        plan.push_back({dot(ray, picture.right) * scale, dot(ray, picture.up) * scale});
        rays.push_back(ray);
    }
    STIPPLE_TRY(triangles, triangulate(plan));
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const BoxD endless{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
    ScreenPrism prism;
    for (const Triangle& triangle : triangles) {
        std::vector<HalfSpace> sides;
        for (std::size_t i = 0; i < 3; ++i) {
            std::size_t a = triangle[i], b = triangle[(i + 1) % 3], c = triangle[(i + 2) % 3];
            std::size_t low = std::min(a, b), high = std::max(a, b); // the same numbers from both sides
            Vec3d across =
                polygon.eye ? cross(rays[low], rays[high]) : cross(picture.forward, rays[high] - rays[low]);
            Vec3d normal = usableNormal(across);
            Vec3d from = polygon.eye ? at : corners[low];
            if (length(normal) == 0)
                return refused(say("two corners of the polygon show at one place"));
            bool isInside = dot(normal, corners[c] - from) < 0;
            sides.push_back({isInside ? normal : normal * -1.0, from, 0});
        }
        prism.parts_.emplace_back(std::move(sides), endless);
    }
    return prism;
}

bool ScreenPrism::contains(Vec3d p) const {
    return std::any_of(parts_.begin(), parts_.end(),
                       [&](const ConvexRegion& part) { return part.contains(p); });
}

Overlap ScreenPrism::overlapOf(const BoxD& box) const {
    Overlap most = Overlap::none;
    for (const ConvexRegion& part : parts_)
        most = std::max(most, part.overlapOf(box));
    return most;
}

ScreenPrism ScreenPrism::near(const BoxD& box) const {
    ScreenPrism some;
    std::copy_if(parts_.begin(), parts_.end(), std::back_inserter(some.parts_),
                 [&](const ConvexRegion& part) { return part.overlapOf(box) != Overlap::none; });
    return some;
}

} // namespace stipple
