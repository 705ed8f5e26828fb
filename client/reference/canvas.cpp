#include "client/reference/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stipple::reference {
namespace {

constexpr double nothing = std::numeric_limits<double>::infinity();

// How far inside the mark a place lies that is (dx, dy) from its middle: > 0 inside, in pixels.
double inside(const Mark& mark, double dx, double dy, PointShape shape) {
    double farther = std::max(std::abs(dx), std::abs(dy)), radius = mark.diameter / 2;
    double holdsMiddle = 0.5 - farther; // the pixel around the place: it always shows what lies in it
    switch (shape) {
    case PointShape::square:
        return std::max(radius - farther, holdsMiddle);
    case PointShape::circle:
        return std::max(radius - std::hypot(dx, dy), holdsMiddle);
    }
    return holdsMiddle;
}

} // namespace

Canvas::Canvas(int width, int height, int samples)
    : samples_(samples), columns_(width * samples), rows_(height * samples) {
    std::size_t count = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    distances_.assign(count, nothing);
    orders_.assign(count, UINT64_MAX);
    colours_.resize(count);
}

std::uint64_t Canvas::bytesFor(int width, int height, int samples) {
    constexpr std::uint64_t sampleBytes = sizeof(double) + sizeof(std::uint64_t) + sizeof(Colour);
    return sampleBytes * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) *
           static_cast<std::uint64_t>(samples) * static_cast<std::uint64_t>(samples);
}

// visit(sample, how far inside) for all samples that lie inside the mark grown by `slack` pixels.
template <class Visit>
void Canvas::visitSamples(const Mark& mark, PointShape shape, double slack, const Visit& visit) const {
    double reach = std::max(mark.diameter / 2, 0.5) + slack;
    auto first = [&](double middle, int count) {
        return static_cast<int>(
            std::clamp(std::floor((middle - reach) * samples_ - 0.5), 0.0, double(count)));
    };
    auto last = [&](double middle, int count) {
        return static_cast<int>(
            std::clamp(std::ceil((middle + reach) * samples_ - 0.5), -1.0, double(count - 1)));
    };
    for (int row = first(mark.y, rows_); row <= last(mark.y, rows_); ++row)
        for (int column = first(mark.x, columns_); column <= last(mark.x, columns_); ++column) {
            double depth =
                inside(mark, (column + 0.5) / samples_ - mark.x, (row + 0.5) / samples_ - mark.y, shape);
            if (depth > -slack)
                visit(at(column, row), depth);
        }
}

void Canvas::draw(std::span<const Mark> marks, PointShape shape) {
    for (const Mark& mark : marks)
        visitSamples(mark, shape, 0, [&](std::size_t sample, double) {
            double held = distances_[sample];
            if (mark.distance > held || (mark.distance == held && mark.order > orders_[sample]))
                return;
            distances_[sample] = mark.distance;
            orders_[sample] = mark.order;
            colours_[sample] = mark.colour;
        });
}

void Canvas::doubt(std::span<const Mark> marks, PointShape shape, const Slack& slack) {
    doubtful_.resize(distances_.size());
    for (const Mark& mark : marks)
        visitSamples(mark, shape, slack.pixels, [&](std::size_t sample, double depth) {
            bool shown = orders_[sample] == mark.order;
            bool mightLeave = shown && depth < slack.pixels;
            bool mightCome = !shown && mark.distance < distances_[sample] * (1 + slack.distance);
            if (mightLeave || mightCome)
                doubtful_[sample] = true;
        });
}

// visit(sample) for the neighbours of eye-dome lighting, whole pixels away.
template <class Visit>
void Canvas::visitNeighbours(const EyeDomeLighting& edl, int x, int y, const Visit& visit) const {
    double radius = std::clamp(edl.radiusPixels, 1.0, 64.0);
    for (int n = 0; n < edl.neighbours; ++n) {
        double angle = 2 * std::numbers::pi * n / edl.neighbours;
        int nx = x + samples_ * static_cast<int>(std::lround(radius * std::cos(angle)));
        int ny = y - samples_ * static_cast<int>(std::lround(radius * std::sin(angle)));
        if (nx >= 0 && ny >= 0 && nx < columns_ && ny < rows_)
            visit(at(nx, ny));
    }
}

// Potree thesis §4.4, eq. 4.5 and 4.6.
double Canvas::shadeOf(const EyeDomeLighting& edl, int x, int y) const {
    double own = std::log2(distances_[at(x, y)]), sum = 0;
    visitNeighbours(edl, x, y, [&](std::size_t neighbour) {
        if (distances_[neighbour] < nothing)
            sum += std::max(0.0, own - std::log2(distances_[neighbour]));
    });
    return std::exp(-sum / edl.neighbours * 300 * edl.strength);
}

DepthImage Canvas::finish(const Style& style) const {
    DepthImage result;
    result.image = {columns_ / samples_, rows_ / samples_, {}};
    for (int y = 0; y < rows_; y += samples_)
        for (int x = 0; x < columns_; x += samples_) {
            std::array<double, 3> sum{};
            double nearest = nothing;
            for (int sy = y; sy < y + samples_; ++sy)
                for (int sx = x; sx < x + samples_; ++sx) {
                    bool covered = distances_[at(sx, sy)] < nothing;
                    double shade = covered && style.edl.enabled ? shadeOf(style.edl, sx, sy) : 1;
                    for (std::size_t c = 0; c < 3; ++c)
                        sum[c] += covered ? double{colours_[at(sx, sy)][c]} * shade : style.background[c];
                    nearest = std::min(nearest, distances_[at(sx, sy)]);
                }
            for (double levels : sum)
                result.image.rgba.push_back(
                    static_cast<std::uint8_t>(std::lround(levels / (samples_ * samples_))));
            result.image.rgba.push_back(255);
            result.distances.push_back(nearest < nothing ? static_cast<float>(nearest) : 0.0f);
        }
    return result;
}

std::vector<bool> Canvas::doubtful(const Style& style) const {
    std::vector<bool> pixels;
    for (int y = 0; y < rows_; y += samples_)
        for (int x = 0; x < columns_; x += samples_) {
            bool any = false;
            for (int sy = y; sy < y + samples_; ++sy)
                for (int sx = x; sx < x + samples_; ++sx) {
                    any = any || doubtful_[at(sx, sy)];
                    if (style.edl.enabled)
                        visitNeighbours(style.edl, sx, sy,
                                        [&](std::size_t neighbour) { any = any || doubtful_[neighbour]; });
                }
            pixels.push_back(any);
        }
    return pixels;
}

} // namespace stipple::reference
