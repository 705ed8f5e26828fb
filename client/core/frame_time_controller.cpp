#include "client/core/frame_time_controller.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stipple {

bool FrameTimeController::frameTook(double took, double wanted) {
    double deviation = took / wanted;
    if (!(took > 0) || !(wanted > 0) || !std::isfinite(deviation))
        return false;
    if (deviation >= leastDeviation && deviation <= mostDeviation)
        return false;
    double next = std::clamp(factor_ * (3 + deviation) / 4, 1.0, most);
    return std::exchange(factor_, next) != next;
}

bool FrameTimeController::reset() {
    return std::exchange(factor_, 1) != 1;
}

} // namespace stipple
