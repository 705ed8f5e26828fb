#include "tests/support/reference_picture.hpp"

#include "client/render/gradients.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace stipple::test {
namespace {

struct Projected {
    double x = 0, y = 0; // pixels from the top left corner
    double distance = 0;
    double diameter = 1; // pixels
    std::array<double, 3> colour{};
};

struct Axes {
    Vec3d right, up, forward;
};

Axes axesOf(const TestView& view) {
    Axes axes;
    axes.forward = normalized(view.target - view.position);
    axes.right = normalized(cross(axes.forward, view.up));
    axes.up = cross(axes.right, axes.forward);
    return axes;
}

std::array<double, 3> colourOf(const TestNode& node, const TestPoint& p, const Style& style) {
    if (style.colourMode == ColourMode::rgb) {
        if (!node.hasColour)
            return {180, 180, 180};
        return {double(p.r), double(p.g), double(p.b)};
    }
    double value, low, high;
    if (style.colourMode == ColourMode::elevation) {
        value = node.world(p).z;
        low = style.elevationRange.min;
        high = style.elevationRange.max;
    } else {
        if (!node.hasIntensity)
            return {180, 180, 180};
        value = p.intensity;
        low = style.intensityRange.min;
        high = style.intensityRange.max;
    }
    double t = std::clamp((value - low) / (high - low), 0.0, 1.0);
    std::uint32_t word = gradientTable(style.gradient)[static_cast<std::size_t>(std::lround(t * 1023))];
    return {double(word & 255), double(word >> 8 & 255), double(word >> 16 & 255)};
}

std::vector<Projected> project(const std::vector<TestNode>& nodes, const TestView& view, const Style& style) {
    Axes axes = axesOf(view);
    bool perspective = view.projection == Projection::perspective;
    std::vector<Projected> all;
    for (const TestNode& node : nodes)
        for (const TestPoint& p : node.points) {
            Vec3d relative = node.world(p) - view.position;
            Projected out;
            out.distance = dot(relative, axes.forward);
            if (out.distance < view.near || out.distance > view.far)
                continue;
            double pixelsPerUnit = perspective ? view.height / (2 * view.tanHalfFovY * out.distance)
                                               : view.height / (2 * view.halfHeight);
            out.x = view.width / 2.0 + dot(relative, axes.right) * pixelsPerUnit;
            out.y = view.height / 2.0 - dot(relative, axes.up) * pixelsPerUnit;
            double wanted =
                style.sizeMode == PointSizeMode::fixed ? style.sizePixels : style.sizeWorld * pixelsPerUnit;
            out.diameter =
                std::clamp(wanted, std::max(1.0, style.minSizePixels), std::min(255.0, style.maxSizePixels));
            out.colour = colourOf(node, p, style);
            all.push_back(out);
        }
    return all;
}

// How far inside the point the centre of pixel (i, j) lies: > 0 inside, in pixels.
double depthInside(const Projected& p, int i, int j, PointShape shape) {
    double dx = std::abs(i + 0.5 - p.x), dy = std::abs(j + 0.5 - p.y);
    double holds = 0.5 - std::max(dx, dy); // the pixel that holds the point is covered always
    double radius = p.diameter / 2;
    double inside = shape == PointShape::circle ? radius - std::hypot(dx, dy) : radius - std::max(dx, dy);
    return std::max(inside, holds);
}

template <class Visit>
void visitPixels(const Projected& p, const TestView& view, PointShape shape, double slack,
                 const Visit& visit) {
    double reach = std::max(p.diameter / 2, 0.5) + slack;
    int firstX = std::max(0, static_cast<int>(std::floor(std::max(-1.0, p.x - reach - 1))));
    int firstY = std::max(0, static_cast<int>(std::floor(std::max(-1.0, p.y - reach - 1))));
    double lastX = std::min<double>(view.width - 1, p.x + reach + 1);
    double lastY = std::min<double>(view.height - 1, p.y + reach + 1);
    for (int j = firstY; j <= lastY; ++j)
        for (int i = firstX; i <= lastX; ++i) {
            double inside = depthInside(p, i, j, shape);
            if (inside > -slack)
                visit(static_cast<std::size_t>(j) * static_cast<std::size_t>(view.width) +
                          static_cast<std::size_t>(i),
                      inside);
        }
}

// Eye-dome lighting as the thesis writes it: equations 4.5 and 4.6.
void shade(ReferencePicture& picture, const TestView& view, const EyeDomeLighting& edl,
           std::vector<std::array<double, 3>>& colours) {
    std::vector<bool> unsure = picture.unsure;
    for (int j = 0; j < view.height; ++j)
        for (int i = 0; i < view.width; ++i) {
            auto at = static_cast<std::size_t>(j * view.width + i);
            double sum = 0;
            for (int n = 0; n < edl.neighbours; ++n) {
                double angle = 2 * std::numbers::pi * n / edl.neighbours;
                int x = i + static_cast<int>(std::lround(edl.radiusPixels * std::cos(angle)));
                int y = j - static_cast<int>(std::lround(edl.radiusPixels * std::sin(angle)));
                if (x < 0 || y < 0 || x >= view.width || y >= view.height)
                    continue;
                auto near = static_cast<std::size_t>(y * view.width + x);
                unsure[at] = unsure[at] || picture.unsure[near];
                if (picture.distances[at] > 0 && picture.distances[near] > 0)
                    sum +=
                        std::max(0.0, std::log2(picture.distances[at]) - std::log2(picture.distances[near]));
            }
            double response = sum / edl.neighbours;
            if (picture.distances[at] > 0)
                for (double& level : colours[at])
                    level *= std::exp(-response * 300 * edl.strength);
        }
    picture.unsure = unsure;
}

} // namespace

ReferencePicture referencePicture(const std::vector<TestNode>& nodes, const TestView& view,
                                  const Style& style, const ReferenceSlack& slack) {
    std::size_t pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
    ReferencePicture picture;
    picture.unsure.assign(pixels, false);
    picture.distances.assign(pixels, 0);
    std::vector<std::size_t> winners(pixels, SIZE_MAX);
    std::vector<Projected> points = project(nodes, view, style);

    // What surely covers a pixel, nearest first.
    for (std::size_t n = 0; n < points.size(); ++n)
        visitPixels(points[n], view, style.shape, 0, [&](std::size_t at, double) {
            if (winners[at] == SIZE_MAX || points[n].distance < points[winners[at]].distance)
                winners[at] = n;
        });
    // What might beat or unseat the winner.
    for (std::size_t n = 0; n < points.size(); ++n)
        visitPixels(points[n], view, style.shape, slack.pixels, [&](std::size_t at, double inside) {
            if (winners[at] == n) {
                if (inside < slack.pixels)
                    picture.unsure[at] = true;
            } else if (winners[at] == SIZE_MAX ||
                       points[n].distance < points[winners[at]].distance * (1 + slack.distance)) {
                picture.unsure[at] = true;
            }
        });

    std::vector<std::array<double, 3>> colours(pixels);
    for (std::size_t at = 0; at < pixels; ++at) {
        const auto& b = style.background;
        if (winners[at] == SIZE_MAX) {
            colours[at] = {double(b[0]), double(b[1]), double(b[2])};
        } else {
            colours[at] = points[winners[at]].colour;
            picture.distances[at] = points[winners[at]].distance;
        }
    }
    if (style.edl.enabled)
        shade(picture, view, style.edl, colours);
    picture.image = {view.width, view.height, {}};
    for (const auto& colour : colours) {
        for (double level : colour)
            picture.image.rgba.push_back(static_cast<std::uint8_t>(std::lround(level)));
        picture.image.rgba.push_back(255);
    }
    return picture;
}

PictureDifference difference(const Image& a, const Image& b, int toleranceLevels) {
    PictureDifference result;
    double sum = 0;
    for (std::size_t at = 0; at + 3 < a.rgba.size(); at += 4) {
        int worst = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            int apart = std::abs(int(a.rgba[at + c]) - int(b.rgba[at + c]));
            worst = std::max(worst, apart);
            sum += apart;
        }
        result.largest = std::max(result.largest, worst);
        result.pixels += worst > toleranceLevels ? 1 : 0;
    }
    result.mean = a.rgba.empty() ? 0 : sum / (static_cast<double>(a.rgba.size()) * 0.75);
    return result;
}

std::size_t wrongPixels(const Image& image, const ReferencePicture& reference, int toleranceLevels) {
    std::size_t wrong = 0;
    for (std::size_t at = 0; at < reference.unsure.size(); ++at) {
        bool differs = false;
        for (std::size_t c = 0; c < 3; ++c)
            differs = differs || std::abs(int(image.rgba[4 * at + c]) -
                                          int(reference.image.rgba[4 * at + c])) > toleranceLevels;
        wrong += differs && !reference.unsure[at] ? 1 : 0;
    }
    return wrong;
}

} // namespace stipple::test
