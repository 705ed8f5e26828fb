#include "shared/geometry/plan_polygon.hpp"

#include "shared/geometry/accurate_sum.hpp"
#include "shared/geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace stipple {

namespace {

using Indices = std::vector<std::size_t>;

bool meet(Point2d a, Point2d b, Point2d c, Point2d d) {
    auto within = [](Point2d p, Point2d q, Point2d r) { // r on the line through p and q: between them?
        return std::min(p.x, q.x) <= r.x && r.x <= std::max(p.x, q.x) && std::min(p.y, q.y) <= r.y &&
               r.y <= std::max(p.y, q.y);
    };
    int c1 = orientation(a, b, c), d1 = orientation(a, b, d);
    int a1 = orientation(c, d, a), b1 = orientation(c, d, b);
    if (c1 * d1 < 0 && a1 * b1 < 0)
        return true;
    return (c1 == 0 && within(a, b, c)) || (d1 == 0 && within(a, b, d)) || (a1 == 0 && within(c, d, a)) ||
           (b1 == 0 && within(c, d, b));
}

// A corner of the polygon that is left, and its neighbours.
struct Place {
    std::size_t before, here, after;
};
Place placeOf(const Indices& left, std::size_t at) {
    std::size_t n = left.size();
    return {left[(at + n - 1) % n], left[at], left[(at + 1) % n]};
}

bool isEarAmong(PlanPolygon corners, const Indices& left, Place place) {
    Point2d a = corners[place.before], b = corners[place.here], c = corners[place.after];
    return orientation(a, b, c) > 0 && std::none_of(left.begin(), left.end(), [&](std::size_t other) {
               return other != place.before && other != place.here && other != place.after &&
                      triangleHolds(a, b, c, corners[other]);
           });
}

// Whether corners are ears, as far as it was asked: cutting one off changes what its neighbours are, and no
// other.
class Ears {
  public:
    explicit Ears(PlanPolygon corners) : corners_(corners), known_(corners.size(), unknown) {}

    bool isEar(const Indices& left, Place place) {
        std::uint8_t& known = known_[place.here];
        if (known == unknown)
            known = isEarAmong(corners_, left, place) ? yes : no;
        return known == yes;
    }
    void cut(Place place) { known_[place.before] = known_[place.after] = unknown; }

  private:
    static constexpr std::uint8_t unknown = 0, no = 1, yes = 2;
    PlanPolygon corners_;
    std::vector<std::uint8_t> known_;
};

// The place in `left` of the ear whose new edge is shortest, or else of a corner on a straight edge; its size
// if there is neither.
std::size_t nextToCut(PlanPolygon corners, const Indices& left, Ears& ears) {
    std::size_t best = left.size();
    double shortest = 0;
    for (std::size_t at = 0; at < left.size(); ++at) {
        Place place = placeOf(left, at);
        Point2d a = corners[place.before], c = corners[place.after];
        double edge = std::hypot(c.x - a.x, c.y - a.y);
        if ((best == left.size() || edge < shortest) && ears.isEar(left, place)) {
            best = at;
            shortest = edge;
        }
    }
    for (std::size_t at = 0; best == left.size() && at < left.size(); ++at) {
        Place place = placeOf(left, at);
        if (orientation(corners[place.before], corners[place.here], corners[place.after]) == 0)
            return at;
    }
    return best;
}

// What is left of the side where sign × (coordinate - bound) <= 0.
std::vector<Point2d> clipToSide(const std::vector<Point2d>& corners, double Point2d::*axis, double sign,
                                double bound) {
    std::vector<Point2d> kept;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        Point2d a = corners[i], b = corners[(i + 1) % corners.size()];
        double overA = sign * (a.*axis - bound), overB = sign * (b.*axis - bound);
        if (overA <= 0)
            kept.push_back(a);
        if ((overA < 0 && overB > 0) || (overA > 0 && overB < 0)) {
            double t = overA / (overA - overB);
            Point2d cut{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
            cut.*axis = bound;
            kept.push_back(cut);
        }
    }
    return kept;
}

Error noPolygon(Phrase what) {
    return Error{ErrorCode::invalidArgument, what, "",
                 say("draw the polygon without crossing its own edges")};
}

} // namespace

bool triangleHolds(Point2d a, Point2d b, Point2d c, Point2d p) {
    return orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0;
}

bool crossesItself(PlanPolygon corners) {
    std::size_t n = corners.size();
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 2; j < n; ++j) // neighbours share a corner
            if (!(i == 0 && j == n - 1) && meet(corners[i], corners[i + 1], corners[j], corners[(j + 1) % n]))
                return true;
    return false;
}

double signedArea(PlanPolygon corners) {
    AccurateSum twice;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        Point2d a = corners[i], b = corners[(i + 1) % corners.size()], o = corners[0];
        twice.addProduct(a.x - o.x, b.y - o.y);
        twice.addProduct(-(a.y - o.y), b.x - o.x);
    }
    return twice.value() / 2;
}

std::vector<Point2d> clipToBox(PlanPolygon corners, Point2d lowest, Point2d highest) {
    std::vector<Point2d> kept(corners.begin(), corners.end());
    kept = clipToSide(kept, &Point2d::x, -1, lowest.x);
    kept = clipToSide(kept, &Point2d::x, 1, highest.x);
    kept = clipToSide(kept, &Point2d::y, -1, lowest.y);
    return clipToSide(kept, &Point2d::y, 1, highest.y);
}

Result<std::vector<Triangle>> triangulate(PlanPolygon corners) {
    Indices left(corners.size());
    std::iota(left.begin(), left.end(), std::size_t{0});
    double area = signedArea(corners);
    if (!(std::abs(area) > 0))
        return noPolygon(say("a polygon needs three corners that are not on one line"));
    if (crossesItself(corners))
        return noPolygon(say("the polygon's edges cross"));
    if (area < 0)
        std::reverse(left.begin(), left.end());
    std::vector<Triangle> triangles;
    Ears ears(corners);
    while (left.size() > 2) {
        std::size_t at = nextToCut(corners, left, ears);
        if (at == left.size())
            return noPolygon(say("the polygon's edges touch"));
        Place place = placeOf(left, at);
        if (orientation(corners[place.before], corners[place.here], corners[place.after]) > 0)
            triangles.push_back({place.before, place.here, place.after});
        ears.cut(place);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
    }
    return triangles;
}

} // namespace stipple
