#include "client/survey/lines.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stipple::survey {

namespace {

constexpr double degrees = 180 / std::numbers::pi;

double spatialLength(Vec3d v) {
    // Squares of 1e-200 or 1e200 neither vanish nor overflow. (Not every library's hypot of three takes that
    // care.)
    return std::hypot(std::hypot(v.x, v.y), v.z);
}

} // namespace

Segment measureSegment(Vec3d from, Vec3d to, const Directions& directions) {
    Vec3d way = to - from;
    Point2d plan = directions.plan(way);
    Segment segment;
    segment.distance = spatialLength(way);
    segment.horizontal = std::hypot(plan.x, plan.y);
    segment.vertical = directions.height(way);
    if (segment.horizontal > 0) {
        double azimuth = std::atan2(plan.x, plan.y) * degrees;
        segment.azimuth = azimuth < 0 ? std::min(azimuth + 360, std::nextafter(360.0, 0.0)) : azimuth;
    }
    if (segment.distance > 0)
        segment.gradient = std::atan2(segment.vertical, segment.horizontal) * degrees;
    return segment;
}

Line measureLine(std::span<const Vec3d> points, const Directions& directions, bool closed) {
    Line line;
    if (points.empty())
        return line;
    std::size_t count = closed && points.size() > 2 ? points.size() : points.size() - 1;
    for (std::size_t i = 0; i < count; ++i) {
        Segment segment = measureSegment(points[i], points[(i + 1) % points.size()], directions);
        line.distance += segment.distance;
        line.horizontal += segment.horizontal;
        line.ascent += std::max(segment.vertical, 0.0);
        line.descent += std::max(-segment.vertical, 0.0);
        line.segments.push_back(segment);
    }
    line.vertical = directions.height(points.back() - points.front());
    for (Vec3d point : points) {
        double height = directions.height(point - points.front());
        line.lowest = std::min(line.lowest, height);
        line.highest = std::max(line.highest, height);
    }
    return line;
}

std::optional<double> angleAt(Vec3d corner, Vec3d a, Vec3d b) {
    Vec3d u = a - corner, v = b - corner;
    double sizeU = spatialLength(u), sizeV = spatialLength(v);
    if (!(sizeU > 0 && sizeV > 0))
        return std::nullopt;
    u = u * (1 / sizeU);
    v = v * (1 / sizeV);
    return 2 * std::atan2(spatialLength(u - v), spatialLength(u + v)) * degrees;
}

} // namespace stipple::survey
