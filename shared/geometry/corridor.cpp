#include "shared/geometry/corridor.hpp"

#include "shared/base/text.hpp"
#include "shared/geometry/exact_sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stipple {

namespace {

double dot(Point2d a, Point2d b) {
    return a.x * b.x + a.y * b.y;
}
double cross(Point2d a, Point2d b) {
    return a.x * b.y - a.y * b.x;
}
Point2d difference(Point2d a, Point2d b) {
    return {a.x - b.x, a.y - b.y};
}
Point2d leftOf(Point2d along) {
    return {-along.y, along.x};
}

// The parts of it that are too small to be multiplied exactly are none.
Point2d unitVector(Point2d from, Point2d to) {
    Point2d d = difference(to, from);
    double size = std::hypot(d.x, d.y);
    Point2d unit{d.x / size, d.y / size};
    return {isExactlySummable(unit.x) ? unit.x : 0, isExactlySummable(unit.y) ? unit.y : 0};
}

// The points p with normal · (p - at) <= distance.
HalfSpace halfPlane(Point2d normal, Point2d at, double distance) {
    return {{normal.x, normal.y, 0}, {at.x, at.y, 0}, distance};
}
Point2d reversed(Point2d v) {
    return {-v.x, -v.y};
}

// Around two points, wider by a little than `distance`, for that and the points are rounded.
BoxD boxAround(Point2d a, Point2d b, double distance) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double size = std::max(std::max(std::abs(a.x), std::abs(a.y)), std::max(std::abs(b.x), std::abs(b.y)));
    double around = distance * (1 + 0x1p-40) + std::hypot(b.x - a.x, b.y - a.y) * 0x1p-40 + size * 0x1p-50;
    return {{std::min(a.x, b.x) - around, std::min(a.y, b.y) - around, -infinity},
            {std::max(a.x, b.x) + around, std::max(a.y, b.y) + around, infinity}};
}

Error invalid(Phrase what, Phrase advice = "") {
    return {ErrorCode::invalidArgument, std::move(what), "", std::move(advice)};
}

} // namespace

Result<Corridor> Corridor::make(const std::vector<Point2d>& line, double width) {
    if (line.size() < 2)
        return invalid(say("a line has at least two points"));
    if (!isExactlySummable(width) || width <= 0)
        return invalid(say("the width ", width, " is no distance"), say("give a number above 0"));
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (!isExactlySummable(line[i].x) || !isExactlySummable(line[i].y))
            return invalid(say("point ", i + 1, " of the line is out of range"));
        if (i > 0 && !(std::hypot(line[i].x - line[i - 1].x, line[i].y - line[i - 1].y) >= 1e-100))
            return invalid(say("points ", i, " and ", i + 1, " of the line are the same"),
                           say("leave one out"));
    }
    Corridor corridor;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        if (i > 0)
            corridor.addCorner(line[i - 1], line[i], line[i + 1], width / 2);
        corridor.addSegment(line[i], line[i + 1], width / 2);
    }
    return corridor;
}

void Corridor::add(Part part) {
    bounds_.extend(part.region.bounds());
    parts_.push_back(std::move(part));
}

void Corridor::addSegment(Point2d from, Point2d to, double halfWidth) {
    Point2d along = unitVector(from, to), left = leftOf(along);
    ConvexRegion region({halfPlane(reversed(along), from, 0), halfPlane(along, to, 0),
                         halfPlane(left, from, halfWidth), halfPlane(reversed(left), from, halfWidth)},
                        boxAround(from, to, halfWidth));
    double size = std::hypot(to.x - from.x, to.y - from.y);
    add({std::move(region), from, along, length_, size, 0});
    length_ += size;
}

void Corridor::addCorner(Point2d before, Point2d at, Point2d after, double halfWidth) {
    Point2d in = unitVector(before, at), out = unitVector(at, after);
    double turn = cross(in, out); // positive to the left
    if (turn == 0)
        return; // straight on, or straight back: nothing is open
    double side = turn > 0 ? -1 : 1;
    Point2d inOuter = leftOf(in), outOuter = leftOf(out); // towards the outside of the turn
    if (side < 0) {
        inOuter = reversed(inOuter);
        outOuter = reversed(outOuter);
    }
    // The tip lies 1 / cos(turn / 2) half widths from the corner, along the sum of the two.
    double halfTurn = std::atan2(std::abs(turn), dot(in, out)) / 2;
    bool isCut = std::cos(halfTurn) * mitreLimit < 1;
    std::vector<HalfSpace> sides{halfPlane(reversed(in), at, 0), halfPlane(out, at, 0),
                                 halfPlane(inOuter, at, halfWidth), halfPlane(outOuter, at, halfWidth)};
    if (isCut) {
        Point2d outward = unitVector({}, difference(in, out));
        sides.push_back(halfPlane(outward, at, halfWidth * std::cos(halfTurn)));
    }
    double reach = halfWidth * (isCut ? 1 : 1 / std::cos(halfTurn));
    double size = std::hypot(after.x - at.x, after.y - at.y);
    add({ConvexRegion(std::move(sides), boxAround(at, at, reach)), at, out, length_, size, side});
}

Overlap Corridor::overlapOf(const BoxD& box) const {
    BoxD flat{{box.min.x, box.min.y, 0}, {box.max.x, box.max.y, 0}};
    Overlap overlap = Overlap::none;
    for (const Part& part : parts_) {
        Overlap one = part.region.overlapOf(flat);
        if (one == Overlap::whole)
            return one;
        if (one == Overlap::partial)
            overlap = one;
    }
    return overlap;
}

std::vector<std::uint32_t> Corridor::partsNear(const BoxD& box) const {
    BoxD flat{{box.min.x, box.min.y, 0}, {box.max.x, box.max.y, 0}};
    std::vector<std::uint32_t> near;
    for (std::uint32_t i = 0; i < parts_.size(); ++i)
        if (parts_[i].region.overlapOf(flat) != Overlap::none)
            near.push_back(i);
    return near;
}

bool Corridor::contains(Point2d p, std::span<const std::uint32_t> parts) const {
    return std::any_of(parts.begin(), parts.end(), [&](std::uint32_t i) {
        return parts_[i].region.contains({p.x, p.y, 0});
    });
}

Corridor::Place Corridor::placeIn(const Part& part, Point2d p) {
    Point2d from = difference(p, part.at);
    if (part.cornerSide != 0)
        return {part.station, part.cornerSide * std::hypot(from.x, from.y)};
    double station = std::clamp(dot(part.along, from), 0.0, part.length);
    return {part.station + station, cross(part.along, from)};
}

std::optional<Corridor::Place> Corridor::placeOf(Point2d p, std::span<const std::uint32_t> parts) const {
    std::optional<Place> nearest;
    for (std::uint32_t i : parts) {
        if (!parts_[i].region.contains({p.x, p.y, 0}))
            continue;
        Place place = placeIn(parts_[i], p);
        if (!nearest || std::abs(place.offset) < std::abs(nearest->offset))
            nearest = place;
    }
    return nearest;
}

} // namespace stipple
