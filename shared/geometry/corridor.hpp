// The strip of a profile: what lies along a line of segments in plan, within half a width of it, at any
// height; and where along the line (station) and how far beside it (offset) a point of it lies.
//
//        ┌──────────────┐╲            each segment's rectangle: flat at both ends of the line
//   ●────┼──────────────●  ╲          corners: what is left open outside a turn is filled to the mitre's tip,
//        └───────┐     ╱ ╲   │         where the two outer edges meet; for turns so sharp that the tip would
//        lie
//                │    ╱    ╲ │         further than mitreLimit × width / 2 from the corner, it is cut off
//                between │   ●     │          the rectangles' outer corners (as SVG 2 §13.5.5 has it)
//
// A point has one place, that of the nearest of those parts that hold it (the earlier, if equally near), so a
// point on the inside of a turn, or where the line crosses itself, is one point.
//
// Whether a point belongs to it is exact for the unit vectors of the segments, rounded to double
// (half_space.hpp), and does not suffer from large coordinates. Stations and offsets are computed from the
// segment's first point and are off by some 2^-52 of the distance from it.
//
// Thread: not altered once made; any number of threads may ask.
#pragma once

#include "shared/base/result.hpp"
#include "shared/geometry/half_space.hpp"
#include "shared/geometry/point2d.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace stipple {

inline constexpr double mitreLimit = 4; // SVG's; turns of more than 151 degrees are cut

class Corridor {
  public:
    // Where a point lies along the line.
    struct Place {
        double station = 0; // from the line's first point to the foot of the point on it: in [0, length()]
        double offset = 0;  // from that foot: positive to the left of the line's direction
        friend bool operator==(const Place&, const Place&) = default;
    };

    // `line`: at least two points. invalidArgument for fewer, for two equal points one after the other, a
    // width that is not above 0, and numbers that are not finite or of a size that half_space.hpp takes.
    static Result<Corridor> make(const std::vector<Point2d>& line, double width);

    double length() const { return length_; }
    const BoxD& bounds() const { return bounds_; } // z: endless

    // Of the box's x and y. `none` and `whole` are certain; `partial` may be said of a box that several parts
    // cover together, or that misses it by little.
    Overlap overlapOf(const BoxD& box) const;
    // The parts that may hold points of the box: what the questions below are asked with.
    std::vector<std::uint32_t> partsNear(const BoxD& box) const;
    bool contains(Point2d p, std::span<const std::uint32_t> parts) const;
    std::optional<Place> placeOf(Point2d p, std::span<const std::uint32_t> parts) const;

  private:
    // A segment's rectangle, or what fills the corner before it.
    struct Part {
        ConvexRegion region;
        Point2d at;            // the segment's first point: the corner
        Point2d along;         // unit vector
        double station = 0;    // of `at`
        double length = 0;     // of the segment
        double cornerSide = 0; // of corners: 1 to the left of the line, -1 to the right; 0 for segments
    };
    Corridor() = default;
    static Place placeIn(const Part& part, Point2d p);
    void addSegment(Point2d from, Point2d to, double halfWidth);
    void addCorner(Point2d before, Point2d at, Point2d after, double halfWidth);
    void add(Part part);

    std::vector<Part> parts_; // along the line
    double length_ = 0;
    BoxD bounds_;
};

} // namespace stipple
