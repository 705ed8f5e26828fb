#include "shared/geometry/polygon.hpp"

#include "shared/geometry/exact_sum.hpp"

#include <cmath>
#include <utility>

namespace stipple {

namespace {

int signOf(double value) {
    return value > 0 ? 1 : value < 0 ? -1 : 0;
}

// (ax - cx)(by - cy) - (ay - cy)(bx - cx), multiplied out: cx cy falls away.
int exactOrientation(Point2d a, Point2d b, Point2d c) {
    ExactSum<12> sum;
    sum.addProduct(a.x, b.y);
    sum.addProduct(-a.x, c.y);
    sum.addProduct(-c.x, b.y);
    sum.addProduct(-a.y, b.x);
    sum.addProduct(a.y, c.x);
    sum.addProduct(c.y, b.x);
    return sum.sign();
}

} // namespace

int orientation(Point2d a, Point2d b, Point2d c) {
    double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
    double difference = left - right;
    // (3 + 16 u) u with u = 2^-53: Shewchuk's bound on the error of this formula.
    constexpr double bound = (3 + 16 * 0x1p-53) * 0x1p-53;
    if (std::abs(difference) > bound * (std::abs(left) + std::abs(right)))
        return signOf(difference);
    return exactOrientation(a, b, c);
}

Ring::Ring(std::vector<Point2d> points) : points_(std::move(points)) {
    if (points_.size() > 1 && points_.front() == points_.back())
        points_.pop_back();
    for (Point2d p : points_)
        bounds_.extend(Vec3d{p.x, p.y, 0});
    // A slab for each edge, unless edges are so long that they would be listed too often.
    std::size_t count = std::max<std::size_t>(1, points_.size());
    while (!fillSlabs(count, 16 * points_.size()))
        count /= 2;
}

// Never falls as y rises, so an edge is listed in the slab of each y it reaches, whatever the rounding.
std::size_t Ring::slabOf(double y) const {
    auto last = static_cast<double>(slabStarts_.size() - 2);
    double slab = (y - bounds_.min.y) * slabsPerUnit_;
    return static_cast<std::size_t>(slab > 0 ? std::min(slab, last) : 0);
}

std::span<const std::uint32_t> Ring::edgesIn(std::size_t slab) const {
    return std::span(slabEdges_).subspan(slabStarts_[slab], slabStarts_[slab + 1] - slabStarts_[slab]);
}

// False if there would be more than `maxEntries` entries (which one slab never has).
bool Ring::fillSlabs(std::size_t count, std::size_t maxEntries) {
    double height = bounds_.max.y - bounds_.min.y;
    slabsPerUnit_ = count > 1 && height > 0 ? static_cast<double>(count) / height : 0;
    if (!std::isfinite(slabsPerUnit_))
        slabsPerUnit_ = 0;
    slabStarts_.assign(count + 1, 0);
    auto slabsOfEdge = [&](std::uint32_t edge) {
        std::size_t a = slabOf(from(edge).y), b = slabOf(to(edge).y);
        return std::pair(std::min(a, b), std::max(a, b));
    };
    std::size_t entries = 0;
    for (std::uint32_t edge = 0; edge < points_.size(); ++edge) {
        auto [first, last] = slabsOfEdge(edge);
        entries += last - first + 1;
        if (entries > maxEntries)
            return false;
    }
    for (std::uint32_t edge = 0; edge < points_.size(); ++edge)
        for (auto [slab, last] = slabsOfEdge(edge); slab <= last; ++slab)
            ++slabStarts_[slab + 1];
    for (std::size_t slab = 0; slab < count; ++slab)
        slabStarts_[slab + 1] += slabStarts_[slab];
    slabEdges_.resize(entries);
    std::vector<std::uint32_t> next(slabStarts_.begin(), slabStarts_.end() - 1);
    for (std::uint32_t edge = 0; edge < points_.size(); ++edge)
        for (auto [slab, last] = slabsOfEdge(edge); slab <= last; ++slab)
            slabEdges_[next[slab]++] = edge;
    return true;
}

// Counts the edges that a ray from p towards +x crosses; an edge owns its lower end and not its upper one, so
// that a ray through a vertex counts right.
Ring::Side Ring::sideOf(Point2d p) const {
    if (!bounds_.contains({p.x, p.y, 0}))
        return Side::outside;
    bool inside = false;
    for (std::uint32_t edge : edgesIn(slabOf(p.y))) {
        Point2d a = from(edge), b = to(edge);
        if (p.y < std::min(a.y, b.y) || p.y > std::max(a.y, b.y) || p.x > std::max(a.x, b.x))
            continue;
        if (a.y == b.y) {
            if (p.x >= std::min(a.x, b.x))
                return Side::boundary;
            continue;
        }
        bool reaches = (a.y <= p.y) != (b.y <= p.y);
        if (p.x < std::min(a.x, b.x)) {
            inside ^= reaches;
            continue;
        }
        int side = orientation(a, b, p);
        if (side == 0)
            return Side::boundary;
        inside ^= reaches && (side > 0) == (b.y > a.y);
    }
    return inside ? Side::inside : Side::outside;
}

bool Ring::touches(const BoxD& box) const {
    if (box.max.x < bounds_.min.x || box.min.x > bounds_.max.x || box.max.y < bounds_.min.y ||
        box.min.y > bounds_.max.y)
        return false;
    // An edge misses a rectangle that it overlaps in x and in y only if all corners lie on one side of it.
    auto meets = [&](Point2d a, Point2d b) {
        if (std::max(a.x, b.x) < box.min.x || std::min(a.x, b.x) > box.max.x ||
            std::max(a.y, b.y) < box.min.y || std::min(a.y, b.y) > box.max.y)
            return false;
        int first = orientation(a, b, {box.min.x, box.min.y});
        for (Point2d corner : {Point2d{box.max.x, box.min.y}, {box.max.x, box.max.y}, {box.min.x, box.max.y}})
            if (orientation(a, b, corner) != first)
                return true;
        return first == 0;
    };
    for (std::size_t slab = slabOf(box.min.y), last = slabOf(box.max.y); slab <= last; ++slab)
        for (std::uint32_t edge : edgesIn(slab))
            if (meets(from(edge), to(edge)))
                return true;
    return false;
}

PolygonRegion::PolygonRegion(std::vector<Polygon> polygons) : polygons_(std::move(polygons)) {
    for (const Polygon& polygon : polygons_)
        bounds_.extend(polygon.outer.bounds());
}

bool PolygonRegion::contains(Point2d p) const {
    for (const Polygon& polygon : polygons_) {
        if (polygon.outer.sideOf(p) == Ring::Side::outside)
            continue;
        bool inHole = false;
        for (const Ring& hole : polygon.holes)
            inHole = inHole || hole.sideOf(p) == Ring::Side::inside;
        if (!inHole)
            return true;
    }
    return false;
}

namespace {
// A box that no edge touches lies on one side of the ring, so one corner speaks for all.
Overlap overlapWith(const Polygon& polygon, const BoxD& box) {
    if (polygon.outer.touches(box))
        return Overlap::partial;
    Point2d corner{box.min.x, box.min.y};
    if (polygon.outer.sideOf(corner) == Ring::Side::outside)
        return Overlap::none;
    bool cut = false;
    for (const Ring& hole : polygon.holes) {
        if (hole.touches(box))
            cut = true;
        else if (hole.sideOf(corner) == Ring::Side::inside)
            return Overlap::none;
    }
    return cut ? Overlap::partial : Overlap::whole;
}
} // namespace

Overlap PolygonRegion::overlapOf(const BoxD& box) const {
    Overlap overlap = Overlap::none;
    for (const Polygon& polygon : polygons_) {
        Overlap one = overlapWith(polygon, box);
        if (one == Overlap::whole)
            return one;
        if (one == Overlap::partial)
            overlap = one;
    }
    return overlap;
}

} // namespace stipple
