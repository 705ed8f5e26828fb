#include "client/reference/shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stipple::reference {
namespace {

struct PlanPoint {
    long double x = 0, y = 0;
};

Vec3l wide(Vec3d v) {
    return {v.x, v.y, v.z};
}
Vec3l minus(const Vec3l& a, const Vec3l& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
long double dotOf(const Vec3l& a, const Vec3l& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vec3l crossOf(const Vec3l& a, const Vec3l& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vec3l unit(const Vec3l& v) {
    long double size = std::sqrt(dotOf(v, v));
    return {v.x / size, v.y / size, v.z / size};
}

enum class Side { outside, edge, inside };

// By the number of edges above the place.
Side sideOf(const std::vector<PlanPoint>& ring, const PlanPoint& p) {
    bool inside = false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        PlanPoint a = ring[i], b = ring[(i + 1) % ring.size()];
        long double area = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
        bool within = p.x >= std::min(a.x, b.x) && p.x <= std::max(a.x, b.x) && p.y >= std::min(a.y, b.y) &&
                      p.y <= std::max(a.y, b.y);
        if (area == 0 && within)
            return Side::edge;
        if ((a.x <= p.x) != (b.x <= p.x))
            inside ^= (area > 0) == (b.x < a.x); // the edge lies above
    }
    return inside ? Side::inside : Side::outside;
}

bool isInRings(const std::vector<std::vector<Point2d>>& rings, const PlanPoint& p) {
    for (std::size_t i = 0; i < rings.size(); ++i) {
        std::vector<PlanPoint> ring;
        for (Point2d corner : rings[i])
            ring.push_back({corner.x, corner.y});
        Side side = sideOf(ring, p);
        if (side == (i == 0 ? Side::outside : Side::inside))
            return false;
    }
    return true;
}

// Where it shows in a picture that looks along `forward`, the eye's place or any other being (0, 0); behind
// the eye: nowhere.
std::optional<PlanPoint> shownAt(const ScreenPolygon& polygon, const Vec3l& world) {
    Vec3l forward = unit(wide(polygon.forward));
    Vec3l right = unit(crossOf(forward, std::abs(forward.z) < 0.9L ? Vec3l{0, 0, 1} : Vec3l{1, 0, 0}));
    Vec3l up = crossOf(right, forward);
    Vec3l from = minus(world, wide(polygon.eye ? *polygon.eye : polygon.corners.front()));
    long double depth = polygon.eye ? dotOf(from, forward) : 1;
    if (depth <= 0)
        return std::nullopt;
    return PlanPoint{dotOf(from, right) / depth, dotOf(from, up) / depth};
}

bool isInPrism(const ScreenPolygon& polygon, const Vec3l& world) {
    if (polygon.eye && world == wide(*polygon.eye))
        return true;
    std::optional<PlanPoint> place = shownAt(polygon, world);
    if (!place)
        return false;
    std::vector<PlanPoint> ring;
    for (const Vec3d& corner : polygon.corners)
        ring.push_back(shownAt(polygon, wide(corner)).value_or(PlanPoint{}));
    return sideOf(ring, *place) != Side::outside;
}

// Along and to the left of a direction in plan, from a place.
PlanPoint turnedTo(const PlanPoint& from, const PlanPoint& along, const PlanPoint& p) {
    long double x = p.x - from.x, y = p.y - from.y;
    return {along.x * x + along.y * y, along.x * y - along.y * x};
}
PlanPoint directionOf(Point2d a, Point2d b) {
    long double x = static_cast<long double>(b.x) - a.x, y = static_cast<long double>(b.y) - a.y;
    long double size = std::hypot(x, y);
    return {x / size, y / size};
}

// Outside of the turn at b: behind the end of the one rectangle, before the beginning of the other, within
// the mitre, or, where that is cut off, within the line between the rectangles' corners.
bool isInCorner(Point2d a, Point2d b, Point2d c, long double half, const PlanPoint& p) {
    PlanPoint in = directionOf(a, b), out = directionOf(b, c), at{b.x, b.y};
    long double turn = in.x * out.y - in.y * out.x, side = turn > 0 ? -1 : 1;
    PlanPoint fromIn = turnedTo(at, in, p), fromOut = turnedTo(at, out, p);
    if (turn == 0 || fromIn.x < 0 || fromOut.x > 0 || side * fromIn.y > half || side * fromOut.y > half)
        return false;
    long double cosine = std::cos(std::atan2(std::abs(turn), in.x * out.x + in.y * out.y) / 2);
    if (cosine * mitreLimit >= 1)
        return true;
    PlanPoint outward{in.x - out.x, in.y - out.y};
    long double size = std::hypot(outward.x, outward.y);
    return turnedTo(at, {outward.x / size, outward.y / size}, p).x <= half * cosine;
}

bool isInCorridor(const std::vector<Point2d>& line, double width, const PlanPoint& p) {
    const long double half = width / 2.0L;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        long double length = std::hypot(static_cast<long double>(line[i + 1].x) - line[i].x,
                                        static_cast<long double>(line[i + 1].y) - line[i].y);
        PlanPoint along = turnedTo({line[i].x, line[i].y}, directionOf(line[i], line[i + 1]), p);
        if (along.x >= 0 && along.x <= length && std::abs(along.y) <= half)
            return true;
        if (i > 0 && isInCorner(line[i - 1], line[i], line[i + 1], half, p))
            return true;
    }
    return false;
}

} // namespace

bool isInBox(const RegionShape::Box& box, const Vec3l& world) {
    std::array<long double, 3> half{box.halfSize.x, box.halfSize.y, box.halfSize.z};
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (std::abs(dotOf(minus(world, wide(box.centre)), wide(box.axes[axis]))) > half[axis])
            return false;
    return true;
}

bool isInShape(const RegionShape& shape, const Vec3l& world) {
    const PlanPoint plan{world.x, world.y};
    return (!shape.box || isInBox(*shape.box, world)) &&
           (shape.rings.empty() || isInRings(shape.rings, plan)) &&
           (shape.line.empty() || isInCorridor(shape.line, shape.width, plan)) &&
           (!shape.prism || isInPrism(*shape.prism, world)) &&
           (!shape.heights || (world.z >= shape.heights->min && world.z <= shape.heights->max));
}

} // namespace stipple::reference
