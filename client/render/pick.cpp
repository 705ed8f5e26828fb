#include "client/render/pick.hpp"

#include "client/render/picture_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace stipple {
namespace {

// The pointer from the picture's bottom left corner.
struct Pointer {
    double x, y;
};
Pointer pointerOf(const RasterFrame& frame, const PickRequest& request) {
    return {request.x, frame.height - request.y};
}

int radiusOf(const PickRequest& request) {
    return std::clamp(request.radius, 0, maxPickRadius);
}

bool isOwnPixel(Pointer pointer, int column, int row) {
    return std::floor(pointer.x) == column && std::floor(pointer.y) == row;
}

double pixelsAway(Pointer pointer, int column, int row) {
    return std::hypot(column + 0.5 - pointer.x, row + 0.5 - pointer.y);
}

PictureWindow windowOf(const RasterFrame& frame, const PickRequest& request) {
    Pointer pointer = pointerOf(frame, request);
    if (!std::isfinite(pointer.x) || !std::isfinite(pointer.y) ||
        std::max(std::abs(pointer.x), std::abs(pointer.y)) > 2.0 * maxPictureSide)
        return {};
    int radius = radiusOf(request);
    auto from = [&](double at) { return std::max(static_cast<int>(std::floor(at)) - radius, 0); };
    auto to = [&](double at, int side) {
        return std::min(static_cast<int>(std::floor(at)) + radius, side - 1);
    };
    PictureWindow window{from(pointer.x), from(pointer.y), 0, 0};
    window.width = to(pointer.x, frame.width) - window.left + 1;
    window.height = to(pointer.y, frame.height) - window.bottom + 1;
    return window;
}

} // namespace

PickTarget pickTarget(const FramePlan& plan, const PickRequest& request) {
    PickTarget target;
    target.request = request;
    if (!isDrawable(plan, maxPictureSide))
        return target;
    target.frame = rasterFrame(plan);
    target.window = windowOf(target.frame, request);
    if (target.window.empty())
        return target;
    target.centres = grownBy(target.window, static_cast<int>(std::ceil(pointReach(target.frame))), plan);
    target.order = nodesIn(plan, target.frame, target.window);
    for (std::size_t i : target.order)
        target.nodes.push_back(plan.nodes[i]);
    return target;
}

std::optional<PickHit> nearestHit(const PickTarget& target, std::span<const PickSample> samples) {
    Pointer pointer = pointerOf(target.frame, target.request);
    auto rank = [&](const PickSample& sample) {
        return std::tuple(pixelsAway(pointer, sample.column, sample.row), sample.step, sample.node,
                          sample.point);
    };
    const PickSample* best = nullptr;
    for (const PickSample& sample : samples) {
        bool near = pixelsAway(pointer, sample.column, sample.row) <= radiusOf(target.request) ||
                    isOwnPixel(pointer, sample.column, sample.row);
        if (near && (!best || rank(sample) < rank(*best)))
            best = &sample;
    }
    if (!best)
        return std::nullopt;
    const DrawNode& node = target.nodes[best->node];
    return PickHit{node.node, node.cloud, best->point, pixelsAway(pointer, best->column, best->row),
                   double{distanceOfStep(target.frame, best->step)}};
}

} // namespace stipple
