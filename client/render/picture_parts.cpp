#include "client/render/picture_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace stipple {
namespace {

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
double largestPoint(const RasterFrame& frame) {
    if (frame.disc && frame.perspective) // what leans towards the eye is seen larger
        return maxPointPixels;
    return static_cast<double>(sizesDiffer(frame) ? frame.maxSize64 : frame.size64) / sizeSteps;
}

int lightingReach(const FramePlan& plan) {
    EdlSetup edl = edlSetup(plan.style.edl);
    int reach = 0;
    for (const auto& offset : edl.offsets)
        reach = std::max({reach, std::abs(offset[0]), std::abs(offset[1])});
    return reach;
}

} // namespace

double pointReach(const RasterFrame& frame) {
    return largestPoint(frame) / 2 + 1;
}

PictureWindow grownBy(const PictureWindow& window, int pixels, const FramePlan& plan) {
    int left = std::max(window.left - pixels, 0), bottom = std::max(window.bottom - pixels, 0);
    int right = std::min(window.left + window.width + pixels, plan.width);
    int top = std::min(window.bottom + window.height + pixels, plan.height);
    return {left, bottom, right - left, top - bottom};
}

PictureWindow withMargin(const PictureWindow& kept, const FramePlan& plan) {
    int points = static_cast<int>(std::ceil(pointReach(rasterFrame(plan))));
    return grownBy(kept, points + lightingReach(plan), plan);
}

std::vector<std::size_t> nodesIn(const FramePlan& plan, const RasterFrame& frame,
                                 const PictureWindow& window) {
    double reach = pointReach(frame);
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

std::vector<std::size_t> partOrder(const FramePlan& plan, const RasterFrame& frame) {
    return plan.part.empty() ? drawOrder(plan) : nodesIn(plan, frame, plan.part);
}

void countOutside(FramePlan& plan, const std::vector<std::size_t>& order) {
    if (!plan.part.empty())
        plan.counters.nodesOutsidePart += plan.nodes.size() - order.size();
}

std::vector<PictureWindow> partsOf(const FramePlan& plan, int width, int height) {
    std::vector<PictureWindow> parts;
    for (int top = plan.height; top > 0; top -= height)
        for (int left = 0; left < plan.width; left += width) {
            int bottom = std::max(top - height, 0);
            parts.push_back({left, bottom, std::min(width, plan.width - left), top - bottom});
        }
    return parts;
}

} // namespace stipple
