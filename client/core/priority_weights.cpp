#include "client/core/priority_weights.hpp"

#include <algorithm>

namespace stipple {

double priorityWeight(const PriorityWeights& weights, const ViewTransform& view, Vec3d centre) {
    if (weights.leastCentre >= 1 && weights.leastDepth >= 1)
        return 1;
    Vec3d at = centre - view.eye;
    double depth = dot(at, view.forward);
    if (depth < view.near)
        return 1;
    double halfY = view.projection == Projection::perspective ? view.tanHalfFovY * depth : view.halfHeight;
    double x = dot(at, view.right) / (halfY * view.aspect), y = dot(at, view.up) / halfY;
    double z = std::min((depth - view.near) / (view.far - view.near), 1.0);
    double centreWeight = 1 - (1 - weights.leastCentre) * std::min(x * x + y * y, 1.0);
    return centreWeight * (1 - (1 - weights.leastDepth) * z * z);
}

} // namespace stipple
