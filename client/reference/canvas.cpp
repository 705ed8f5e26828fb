#include "client/reference/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stipple::reference {
namespace {

constexpr double nothing = std::numeric_limits<double>::infinity();

// The last of it: a pixel that only its point's place covers shows that point all the same.
double weightAt(const Mark& mark, double away, const Splats& splats) {
    double share = 2 * away / mark.diameter;
    return std::pow(std::max(0.0, 1 - share * share), splats.hardness) + 1.0 / 65536;
}

double blendDepth(const Mark& mark, const Splats& splats) {
    return mark.diameter / 2 * mark.unitsPerPixel + splats.depthFactor * mark.distance;
}

} // namespace

Canvas::Canvas(int width, int height, int samples)
    : samples_(samples), columns_(width * samples), rows_(height * samples) {
    std::size_t count = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    distances_.assign(count, nothing);
    orders_.assign(count, UINT64_MAX);
    colours_.resize(count);
}

std::uint64_t Canvas::bytesFor(int width, int height, int samples, bool splats) {
    std::uint64_t sampleBytes = sizeof(double) + sizeof(std::uint64_t) + sizeof(Colour) +
                                (splats ? sizeof(std::array<double, 4>) : 0);
    return sampleBytes * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) *
           static_cast<std::uint64_t>(samples) * static_cast<std::uint64_t>(samples);
}

// visit(sample, spot) for all samples that lie inside the mark, grown by the slack.
template <class Visit>
void Canvas::visitSamples(const Mark& mark, PointShape shape, const Slack* slack, const Visit& visit) const {
    double grown = slack ? slack->pixels : 0, reach = reachOf(mark, shape) + grown;
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
            double dx = (column + 0.5) / samples_ - mark.x, dy = (row + 0.5) / samples_ - mark.y;
            Spot spot = spotOf(mark, dx, dy, shape, slack);
            if (spot.inside > -grown)
                visit(at(column, row), spot);
        }
}

PointShape drawnShape(const Style& style) {
    return style.splats.enabled && style.shape == PointShape::paraboloid ? PointShape::circle : style.shape;
}

void Canvas::draw(std::span<const Mark> marks, PointShape shape) {
    for (const Mark& mark : marks)
        visitSamples(mark, shape, nullptr, [&](std::size_t sample, const Spot& spot) {
            double held = distances_[sample];
            if (spot.distance > held || (spot.distance == held && mark.order > orders_[sample]))
                return;
            distances_[sample] = spot.distance;
            orders_[sample] = mark.order;
            colours_[sample] = mark.colour;
        });
}

void Canvas::blend(std::span<const Mark> marks, const Style& style) {
    sums_.resize(distances_.size());
    for (const Mark& mark : marks)
        visitSamples(mark, drawnShape(style), nullptr, [&](std::size_t sample, const Spot& spot) {
            if (spot.distance - blendDepth(mark, style.splats) > distances_[sample])
                return;
            double weight = weightAt(mark, spot.away, style.splats);
            for (std::size_t c = 0; c < 3; ++c)
                sums_[sample][c] += weight * double{mark.colour[c]};
            sums_[sample][3] += weight;
        });
}

void Canvas::doubt(std::span<const Mark> marks, const Style& style, const Slack& slack) {
    doubtful_.resize(distances_.size());
    distanceSlack_.resize(distances_.size());
    swings_.resize(sums_.size());
    PointShape shape = drawnShape(style);
    for (const Mark& mark : marks)
        visitSamples(mark, shape, &slack, [&](std::size_t sample, const Spot& spot) {
            if (orders_[sample] == mark.order)
                distanceSlack_[sample] = spot.spread;
        });
    for (const Mark& mark : marks)
        visitSamples(mark, shape, &slack, [&](std::size_t sample, const Spot& spot) {
            double nearest = distances_[sample];
            if (style.splats.enabled) {
                doubtBlend(mark, sample, spot, style.splats, slack);
                return;
            }
            bool shown = orders_[sample] == mark.order;
            bool mightLeave = shown && spot.inside < slack.pixels;
            double moves = spot.spread + distanceSlack_[sample];
            bool mightCome = !shown && spot.distance < nearest * (1 + slack.distance) + moves;
            if (mightLeave || mightCome)
                doubtful_[sample] = true;
        });
}

// What a sample shows changes at once where its nearest point does, or where one comes within the blend
// depth; and little by little with the weights.
void Canvas::doubtBlend(const Mark& mark, std::size_t sample, const Spot& spot, const Splats& splats,
                        const Slack& slack) {
    double nearest = distances_[sample], moves = spot.spread + distanceSlack_[sample];
    bool isEdge = std::abs(spot.inside) < slack.pixels;
    bool movesNearest = isEdge && spot.distance < nearest * (1 + slack.distance) + moves;
    double beyond = spot.distance - blendDepth(mark, splats) - nearest;
    bool mightBlend =
        std::abs(beyond) < 2 * slack.distance * mark.distance + slack.pixels * mark.unitsPerPixel + moves;
    if (movesNearest || mightBlend)
        doubtful_[sample] = true;
    if (beyond > 0 || !(sums_[sample][3] > 0))
        return;
    double change = weightAt(mark, std::max(0.0, spot.away - spot.wander), splats) -
                    weightAt(mark, spot.away + spot.wander, splats);
    if (isEdge) // it might come or go
        change = std::max(change, 2 * weightAt(mark, spot.away, splats));
    double apart = 0;
    for (std::size_t c = 0; c < 3; ++c)
        apart = std::max(apart, std::abs(double{mark.colour[c]} - sums_[sample][c] / sums_[sample][3]));
    constexpr double weightStep = 1.0 / 65536; // renderers round weights to it
    swings_[sample] += (change / 2 + weightStep) * apart / sums_[sample][3];
    bool dominates = change > sums_[sample][3] / 2; // the mean does not follow in proportion
    if (swings_[sample] > slack.levels || dominates)
        doubtful_[sample] = true;
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

Colour Canvas::colourAt(std::size_t sample) const {
    if (sums_.empty())
        return colours_[sample];
    Colour mean;
    for (std::size_t c = 0; c < 3; ++c)
        mean[c] = static_cast<float>(sums_[sample][c] / sums_[sample][3]);
    return mean;
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
                    Colour colour = covered ? colourAt(at(sx, sy)) : Colour{};
                    for (std::size_t c = 0; c < 3; ++c)
                        sum[c] += covered ? double{colour[c]} * shade : style.background[c];
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

std::vector<double> Canvas::distanceSlack() const {
    std::vector<double> pixels;
    for (int y = 0; y < rows_; y += samples_)
        for (int x = 0; x < columns_; x += samples_) {
            double most = 0;
            for (int sy = y; sy < y + samples_; ++sy)
                for (int sx = x; sx < x + samples_; ++sx)
                    most = std::max(most, distanceSlack_[at(sx, sy)]);
            pixels.push_back(most);
        }
    return pixels;
}

} // namespace stipple::reference
