#include "client/render/raster_setup.hpp"

#include "client/core/continuous_detail.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <tuple>

namespace stipple {
namespace {

// Pixels a world unit takes: at distance 1 in perspective, anywhere in orthographic views.
struct Focal {
    double x, y;
};
Focal focalOf(const FramePlan& plan) {
    const ViewTransform& view = plan.view;
    double halfHeight = view.projection == Projection::perspective ? view.tanHalfFovY : view.halfHeight;
    return {plan.width / (2 * halfHeight * view.aspect), plan.height / (2 * halfHeight)};
}

int sizeStepsOf(double pixels) {
    return static_cast<int>(std::lround(std::clamp(pixels, 1.0, double{maxPointPixels}) * sizeSteps));
}

// At distance 1 where size goes with distance; the same for all points elsewhere.
double sizePixelsOf(const FramePlan& plan) {
    const Style& style = plan.style;
    if (style.sizeMode == PointSizeMode::world)
        return style.sizeWorld * focalOf(plan).y;
    if (style.sizeMode == PointSizeMode::spacing && plan.detailPixels > 0)
        return style.sizeSpacings * plan.detailPixels;
    return style.sizePixels;
}

void setDetail(const FramePlan& plan, RasterFrame& frame) {
    const Detail& detail = plan.style.detail;
    frame.continuous = plan.detailPixels > 0;
    if (!frame.continuous)
        return;
    double rest = 1 - detail.growthRange;
    // A range of 0 would divide by it: grown at once, as good as.
    frame.growth = static_cast<float>(1 / std::max(1 - rest * rest, 1e-6));
    frame.falloffX = static_cast<float>(detail.peripheralFalloff / (plan.width * 0.5));
    frame.falloffY = static_cast<float>(detail.peripheralFalloff / (plan.height * 0.5));
    frame.leastDensity = static_cast<float>(detail.peripheralDensity);
    frame.sizeByDensity = plan.style.sizeMode == PointSizeMode::spacing && detail.peripheralFalloff > 0;
}

// Pixels are square: the focal lengths differ by rounding at most.
void setDiscs(const FramePlan& plan, RasterFrame& frame) {
    for (int axis = 0; axis < 3; ++axis) {
        auto i = static_cast<std::size_t>(axis);
        frame.discRight[i] = static_cast<float>(plan.view.right[axis] / 32767);
        frame.discUp[i] = static_cast<float>(plan.view.up[axis] / 32767);
        frame.discForward[i] = static_cast<float>(plan.view.forward[axis] / 32767);
    }
    frame.pixelUnits = static_cast<float>(1 / focalOf(plan).y);
    frame.pixelSlope = frame.perspective ? frame.pixelUnits : 0;
}

int depthShiftOf(std::uint32_t nearBits, std::uint32_t farBits) {
    return std::max(0, static_cast<int>(std::bit_width(farBits - nearBits)) - depthBits);
}

// How far from the camera a point of the node can lie, in pixels, summed over the axes.
double reachPixels(const DrawNode& node, double focal) {
    double reach = 0, side = std::ldexp(1.0, node.node->nodeBits);
    for (std::size_t i = 0; i < 3; ++i) {
        double from = node.cameraCell[i] + node.cameraOffset[i];
        reach += std::max(std::abs(from), std::abs(side - from)) * node.scale[static_cast<int>(i)];
    }
    return reach * focal;
}

// `pixels` in units of 2^-fractionBits, modulo 2^32; what lies between two units goes to the nearer.
std::uint32_t wrapped(double pixels, int fractionBits) {
    double units = std::fmod(std::ldexp(pixels, fractionBits), 0x1p32);
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::llround(units)));
}

// From here on floats are off by half a thousandth of a pixel.
constexpr double deepPixels = 8192;

void setDeep(const FramePlan& plan, const DrawNode& node, double focalX, double focalY, RasterNode& raster) {
    double reach = reachPixels(node, std::max(focalX, focalY));
    raster.deep = plan.view.projection == Projection::orthographic && reach > deepPixels;
    if (!raster.deep)
        return;
    int bits = raster.fractionBits = std::clamp(24 - (std::ilogb(reach) - 28), 8, 24);
    double x = plan.width * 0.5, y = plan.height * 0.5;
    for (int axis = 0; axis < 3; ++axis) {
        auto i = static_cast<std::size_t>(axis);
        double rowX = plan.view.right[axis] * node.scale[axis] * focalX;
        double rowY = plan.view.up[axis] * node.scale[axis] * focalY;
        raster.lowX[i] = wrapped(rowX, bits);
        raster.highX[i] = wrapped(rowX, bits + 16);
        raster.lowY[i] = wrapped(rowY, bits);
        raster.highY[i] = wrapped(rowY, bits + 16);
        x -= node.cameraOffset[i] * rowX;
        y -= node.cameraOffset[i] * rowY;
    }
    raster.originX = wrapped(x, bits);
    raster.originY = wrapped(y, bits);
}

// The middle of a node along the view direction, world units.
double centreDistance(const ViewTransform& view, const DrawNode& node) {
    double half = std::ldexp(0.5, node.node->nodeBits);
    Vec3d relative;
    for (int axis = 0; axis < 3; ++axis)
        relative[axis] =
            (half - node.cameraCell[axis] - double{node.cameraFraction[axis]}) * node.scale[axis];
    return dot(relative, view.forward);
}

} // namespace

PictureWindow drawnWindow(const FramePlan& plan) {
    return plan.part.empty() ? PictureWindow{0, 0, plan.width, plan.height} : plan.part;
}

bool isDrawable(const FramePlan& plan, int mostSide) {
    PictureWindow drawn = drawnWindow(plan);
    auto fits = [&](int first, int side, int whole) {
        return whole >= 1 && whole <= maxPictureSide && first >= 0 && side >= 1 && side <= mostSide &&
               first <= whole - side;
    };
    return fits(drawn.left, drawn.width, plan.width) && fits(drawn.bottom, drawn.height, plan.height);
}

RasterFrame rasterFrame(const FramePlan& plan) {
    const Style& style = plan.style;
    PictureWindow drawn = drawnWindow(plan);
    RasterFrame frame;
    frame.width = drawn.width;
    frame.height = drawn.height;
    frame.left = drawn.left;
    frame.bottom = drawn.bottom;
    frame.perspective = plan.view.projection == Projection::perspective;
    frame.centreX = static_cast<float>(plan.width * 0.5);
    frame.centreY = static_cast<float>(plan.height * 0.5);
    frame.near = static_cast<float>(plan.view.near);
    frame.far = static_cast<float>(plan.view.far);
    frame.nearBits = floatBits(frame.near);
    frame.depthShift = depthShiftOf(frame.nearBits, floatBits(frame.far));

    frame.minSize64 = sizeStepsOf(style.minSizePixels);
    frame.maxSize64 = std::max(frame.minSize64, sizeStepsOf(style.maxSizePixels));
    double pixels = sizePixelsOf(plan);
    frame.sizeByDistance = style.sizeMode == PointSizeMode::world && frame.perspective;
    frame.worldSize64 = static_cast<float>(pixels * sizeSteps);
    frame.size64 = std::clamp(sizeStepsOf(pixels), frame.minSize64, frame.maxSize64);
    frame.radiusScale = static_cast<float>(0.5 / sizeSteps / focalOf(plan).y);
    frame.splats = style.splats.enabled;
    frame.hardness = style.splats.hardness;
    frame.blendFactor = static_cast<float>(style.splats.depthFactor);
    setDetail(plan, frame);
    frame.adaptive = style.sizeMode == PointSizeMode::adaptive;
    frame.growing = style.growsWhileLoading && !plan.awaited.empty() && !frame.adaptive &&
                    style.sizeMode != PointSizeMode::world && frame.maxSize64 > frame.size64;
    bool singlePixels = (sizesDiffer(frame) ? frame.maxSize64 : frame.size64) == sizeSteps;
    frame.circle = style.shape != PointShape::square && !singlePixels;
    frame.paraboloid = style.shape == PointShape::paraboloid && frame.circle && !frame.splats;
    frame.disc = style.shape == PointShape::disc && frame.circle;
    if (frame.disc)
        setDiscs(plan, frame);
    return frame;
}

bool expandsLate(const FramePlan& plan, const RasterFrame& frame, const ExpansionCosts& costs) {
    if ((sizesDiffer(frame) ? frame.maxSize64 : frame.size64) == sizeSteps)
        return false;
    if (plan.style.delayedExpansion != DelayedExpansion::automatic)
        return plan.style.delayedExpansion == DelayedExpansion::on;
    double points = 0, pixels = double{1} * plan.width * plan.height;
    for (const DrawNode& node : plan.nodes)
        points += node.pointCount;
    return points > pixels * (frame.splats ? costs.pointsPerPixelSplats : costs.pointsPerPixel);
}

RasterFrame singlePixelFrame(const RasterFrame& frame) {
    RasterFrame single = frame;
    single.size64 = sizeSteps;
    single.sizeByDistance = single.sizeByDensity = single.adaptive = single.growing = single.circle =
        single.splats = false;
    single.paraboloid = single.disc = false;
    return single;
}

RasterNode rasterNode(const FramePlan& plan, const DrawNode& node) {
    RasterNode raster;
    Focal focal = focalOf(plan);
    for (int axis = 0; axis < 3; ++axis) {
        auto i = static_cast<std::size_t>(axis);
        raster.rowX[i] = static_cast<float>(plan.view.right[axis] * node.scale[axis] * focal.x);
        raster.rowY[i] = static_cast<float>(plan.view.up[axis] * node.scale[axis] * focal.y);
        raster.rowD[i] = static_cast<float>(plan.view.forward[axis] * node.scale[axis]);
    }
    raster.fraction = node.cameraFraction;
    raster.cell = node.cameraCell;
    raster.positionShift = node.node->positionShift;
    setDeep(plan, node, focal.x, focal.y, raster);
    if (plan.detailPixels > 0) {
        double target = plan.detailPixels / focal.y; // world units, at distance 1 in perspective
        raster.rankBase = static_cast<float>(node.density.base * target * target);
        raster.rankStep = static_cast<float>(node.density.step * target * target);
    }
    raster.nodeSize64 = static_cast<float>(node.spacing * plan.style.sizeSpacings * focal.y * sizeSteps);
    return raster;
}

std::vector<std::size_t> drawOrder(const FramePlan& plan) {
    using Place = std::tuple<double, NodeKey, std::uint64_t, std::size_t>;
    std::vector<Place> places;
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
        const DrawNode& node = plan.nodes[i];
        if (node.node && node.pointCount > 0)
            places.emplace_back(centreDistance(plan.view, node), node.node->key, node.node->id, i);
    }
    std::sort(places.begin(), places.end());
    std::vector<std::size_t> order;
    for (const Place& place : places)
        order.push_back(std::get<3>(place));
    return order;
}

EdlSetup edlSetup(const EyeDomeLighting& style) {
    EdlSetup setup;
    setup.enabled = style.enabled && style.strength > 0;
    if (!setup.enabled)
        return setup;
    setup.neighbours = style.neighbours <= 4 ? 4 : 8;
    double radius = std::clamp(style.radiusPixels, 1.0, 64.0);
    for (int i = 0; i < setup.neighbours; ++i) {
        double angle = 2 * std::numbers::pi * i / setup.neighbours;
        setup.offsets[static_cast<std::size_t>(i)] = {
            static_cast<int>(std::lround(radius * std::cos(angle))),
            static_cast<int>(std::lround(radius * std::sin(angle)))};
    }
    setup.power = static_cast<float>(300 * style.strength / (setup.neighbours * std::numbers::ln2));
    return setup;
}

} // namespace stipple
