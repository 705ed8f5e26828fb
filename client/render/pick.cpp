#include "client/render/pick.hpp"

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

// Half spaces through which a point of the window is seen, of positions relative to the eye: dot(normal,
// position) >= -reach. In perspective all go through the eye.
struct Side {
    Vec3d normal; // of length 1
    double reach = 0;
};

// `left` etc.: the window's edges from -1 to 1 over the picture.
std::array<Side, 4> sidesOf(const ViewTransform& view, double left, double right, double bottom, double top) {
    bool perspective = view.projection == Projection::perspective;
    double halfY = perspective ? view.tanHalfFovY : view.halfHeight, halfX = halfY * view.aspect;
    auto side = [&](Vec3d axis, double edge, double sign) {
        if (!perspective)
            return Side{axis * sign, -sign * edge};
        return Side{normalized(axis * sign - view.forward * (sign * edge)), 0};
    };
    return {side(view.right, left * halfX, 1), side(view.right, right * halfX, -1),
            side(view.up, bottom * halfY, 1), side(view.up, top * halfY, -1)};
}

// Sphere around a node, relative to the eye.
struct Ball {
    Vec3d centre;
    double radius = 0;
};
Ball ballOf(const DrawNode& node) {
    Ball ball;
    Vec3d half;
    double steps = std::ldexp(0.5, node.node->nodeBits);
    for (int axis = 0; axis < 3; ++axis) {
        auto i = static_cast<std::size_t>(axis);
        half[axis] = steps * node.scale[axis];
        ball.centre[axis] = (steps - node.cameraCell[i] - node.cameraOffset[i]) * node.scale[axis];
    }
    ball.radius = length(half);
    return ball;
}

// Diameter, pixels.
double largestPoint(const RasterFrame& frame, const Style& style) {
    bool same = style.sizeMode == PointSizeMode::fixed;
    if (frame.disc && frame.perspective) // what leans towards the eye is seen larger
        return maxPointPixels;
    return static_cast<double>(same ? frame.size64 : frame.maxSize64) / sizeSteps;
}

PickWindow windowOf(const RasterFrame& frame, const PickRequest& request) {
    Pointer pointer = pointerOf(frame, request);
    if (!std::isfinite(pointer.x) || !std::isfinite(pointer.y) ||
        std::max(std::abs(pointer.x), std::abs(pointer.y)) > 2.0 * maxPictureSide)
        return {};
    int radius = radiusOf(request);
    auto from = [&](double at) { return std::max(static_cast<int>(std::floor(at)) - radius, 0); };
    auto to = [&](double at, int side) {
        return std::min(static_cast<int>(std::floor(at)) + radius, side - 1);
    };
    PickWindow window{from(pointer.x), from(pointer.y), 0, 0};
    window.width = to(pointer.x, frame.width) - window.left + 1;
    window.height = to(pointer.y, frame.height) - window.bottom + 1;
    return window;
}

// How far from the pixels that it covers a point's centre can be; a pixel more covers all rounding.
double reachOf(const RasterFrame& frame, const Style& style) {
    return largestPoint(frame, style) / 2 + 1;
}

PickWindow grownBy(const PickWindow& window, int pixels, const RasterFrame& frame) {
    int left = std::max(window.left - pixels, 0), bottom = std::max(window.bottom - pixels, 0);
    int right = std::min(window.left + window.width + pixels, frame.width);
    int top = std::min(window.bottom + window.height + pixels, frame.height);
    return {left, bottom, right - left, top - bottom};
}

std::vector<std::size_t> nodesAt(const FramePlan& plan, const RasterFrame& frame, const PickWindow& window) {
    double reach = reachOf(frame, plan.style);
    auto edge = [](double pixel, int side) { return 2 * pixel / side - 1; };
    std::array<Side, 4> sides = sidesOf(plan.view, edge(window.left - reach, plan.width),
                                        edge(window.left + window.width + reach, plan.width),
                                        edge(window.bottom - reach, plan.height),
                                        edge(window.bottom + window.height + reach, plan.height));
    std::vector<std::size_t> order = drawOrder(plan);
    std::erase_if(order, [&](std::size_t i) {
        Ball ball = ballOf(plan.nodes[i]);
        double slack = 1e-9 * (length(ball.centre) + ball.radius);
        return std::any_of(sides.begin(), sides.end(), [&](const Side& side) {
            return dot(side.normal, ball.centre) + side.reach < -ball.radius - slack;
        });
    });
    return order;
}

} // namespace

PickTarget pickTarget(const FramePlan& plan, const PickRequest& request) {
    PickTarget target;
    target.request = request;
    bool drawable =
        std::min(plan.width, plan.height) >= 1 && std::max(plan.width, plan.height) <= maxPictureSide;
    if (!drawable)
        return target;
    target.frame = rasterFrame(plan);
    target.window = windowOf(target.frame, request);
    if (target.window.empty())
        return target;
    target.centres =
        grownBy(target.window, static_cast<int>(std::ceil(reachOf(target.frame, plan.style))), target.frame);
    target.order = nodesAt(plan, target.frame, target.window);
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
