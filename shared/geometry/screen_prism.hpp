// What a polygon that was drawn on the screen reaches into: the places that show inside it, at any depth.
// Seen in perspective it is a cone from the eye, without end; seen in parallel a column, endless both ways.
// Any simple polygon; closed: what shows on an edge belongs to it.
//
// The polygon is dealt into triangles, and each becomes the half-spaces of its edges. Their normals are
// rounded to double once; from there on membership is exact (half_space.hpp). An edge that two triangles
// share has one plane, so none of what lies between them is lost.
//
// Thread: not altered once made; any number of threads may ask.
#pragma once

#include "shared/base/result.hpp"
#include "shared/geometry/half_space.hpp"

#include <optional>
#include <vector>

namespace stipple {

inline constexpr std::size_t maxScreenCorners = 1000;

// The polygon, in world coordinates, so that it stays what it was when the camera moves on.
struct ScreenPolygon {
    std::optional<Vec3d> eye; // none: parallel rays
    Vec3d forward{0, 1, 0};   // the direction of view
    // A place that shows at each corner, in front of the eye; at least three.
    std::vector<Vec3d> corners;
    friend bool operator==(const ScreenPolygon&, const ScreenPolygon&) = default;
};

class ScreenPrism {
  public:
    // invalidArgument for numbers that can't be computed with, corners beside or behind the eye, polygons
    // without area, and edges that cross.
    static Result<ScreenPrism> make(const ScreenPolygon& polygon);

    bool contains(Vec3d p) const;
    // `none` and `whole` are certain; `partial` may be said of a box that several triangles cover together,
    // or that misses the prism by little.
    Overlap overlapOf(const BoxD& box) const;
    // What holds the same places of `box`, made of those of the triangles that may hold any.
    ScreenPrism near(const BoxD& box) const;

  private:
    ScreenPrism() = default;
    std::vector<ConvexRegion> parts_;
};

} // namespace stipple
