// Regions of the plane bounded by polygons, as GeoJSON has them (RFC 7946 §3.1.6, §3.1.7), and exact answers
// to "is this point in it?".
//
// A polygon is its outer ring less the insides of its holes; a ring's inside is by the even-odd rule. The
// region is closed: points on an edge or vertex, of an outer ring or of a hole, belong to it. A region of
// several polygons is their union, also where they overlap.
//
// The answers are exact for the doubles given: which side of an edge a point lies on is computed without
// rounding wherever rounding could matter (shared/geometry/exact_sum.hpp). That holds for coordinates of
// magnitude 1e-100 to 1e100, and 0.
//
// Thread: a region is not altered once made; any number of threads may ask.
#pragma once

#include "shared/geometry/box.hpp"
#include "shared/geometry/overlap.hpp"
#include "shared/geometry/point2d.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stipple {

// Sign of twice the signed area of a, b, c: 1 if c lies to the left of a → b, -1 to the right, 0 on the line.
int orientation(Point2d a, Point2d b, Point2d c);

// A closed ring with its edges indexed by y: a question looks at the edges near its y alone.
class Ring {
  public:
    enum class Side : std::uint8_t { outside, boundary, inside };

    // At least 3 points; the last is joined with the first (and may equal it). Finite coordinates.
    explicit Ring(std::vector<Point2d> points);

    Side sideOf(Point2d p) const;
    // Does an edge meet the closed rectangle (x and y of the box)?
    bool touches(const BoxD& box) const;
    const BoxD& bounds() const { return bounds_; } // z: 0
    std::size_t size() const { return points_.size(); }

  private:
    std::size_t slabOf(double y) const;
    std::span<const std::uint32_t> edgesIn(std::size_t slab) const;
    bool fillSlabs(std::size_t count, std::size_t maxEntries);
    Point2d from(std::uint32_t edge) const { return points_[edge]; }
    Point2d to(std::uint32_t edge) const { return points_[edge + 1 < points_.size() ? edge + 1 : 0]; }

    std::vector<Point2d> points_;
    BoxD bounds_;
    double slabsPerUnit_ = 0;
    std::vector<std::uint32_t> slabStarts_; // of each slab in slabEdges_, then the end
    std::vector<std::uint32_t> slabEdges_;
};

struct Polygon {
    Ring outer;
    std::vector<Ring> holes;
};

class PolygonRegion {
  public:
    explicit PolygonRegion(std::vector<Polygon> polygons);

    bool contains(Point2d p) const;
    // Of the box's x and y. `none` and `whole` are certain; `partial` may be said of a box that only
    // touches an edge.
    Overlap overlapOf(const BoxD& box) const;
    const BoxD& bounds() const { return bounds_; } // z: 0
    const std::vector<Polygon>& polygons() const { return polygons_; }

  private:
    std::vector<Polygon> polygons_;
    BoxD bounds_;
};

} // namespace stipple
