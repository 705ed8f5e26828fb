#include "client/survey/circles.hpp"

#include <algorithm>

namespace stipple::survey {

Result<Circle> circleThrough(Vec3d a, Vec3d b, Vec3d c) {
    Vec3d u = b - a, v = c - a;
    double longest = std::max({length(u), length(v), length(c - b)});
    Vec3d normal = cross(u, v); // twice the area
    if (!(length(normal) > 1e-12 * longest * longest))
        return Error{ErrorCode::invalidArgument, say("no circle goes through three points on one line"), "",
                     say("pick points that are farther apart")};
    double square = dot(normal, normal);
    Vec3d toCentre = (cross(v, normal) * dot(u, u) + cross(normal, u) * dot(v, v)) * (0.5 / square);
    return Circle{a + toCentre, normalized(normal), length(toCentre)};
}

} // namespace stipple::survey
