#include "client/core/openings.hpp"

#include "client/core/frustum.hpp"

#include <algorithm>
#include <limits>

namespace stipple {

namespace {
constexpr double leastPixels = 1;
} // namespace

double openingPixels(const CloudLoader& cloud, const SessionView& view) {
    const BoxD& box = cloud.state.expected;
    if (box.empty() || cloud.opensAnywhere)
        return std::numeric_limits<double>::infinity();
    return projectedPixels(view.transform, view.height, (box.min + box.max) * 0.5,
                           length(box.max - box.min) / 2);
}

std::uint64_t chooseOpenings(CloudMap& clouds, const SessionView& view) {
    Frustum frustum(view.transform);
    auto isNeeded = [&](const CloudLoader& cloud) {
        if (cloud.opensAnywhere)
            return true;
        if (!cloud.state.visible)
            return false;
        const BoxD& box = cloud.state.expected;
        return box.empty() || (frustum.intersects(box) && openingPixels(cloud, view) >= leastPixels);
    };
    std::uint64_t waiting = 0;
    for (auto& [id, cloud] : clouds) {
        if (cloud.state.stage != CloudStage::opening)
            continue;
        cloud.isToOpen = isNeeded(cloud);
        waiting += !cloud.isToOpen;
    }
    return waiting;
}

} // namespace stipple
