// What a view sees of boxes and spheres, in double precision, relative to its eye.
#pragma once

#include "client/core/frame_plan.hpp"
#include "shared/geometry/box.hpp"

#include <array>
#include <vector>

namespace stipple {

// The space that a view shows: in perspective the pyramid from the eye through the picture's corners, in
// orthographic views the prism over the picture; both without an end (near and far enclose the content).
class Frustum {
  public:
    explicit Frustum(const ViewTransform& view);

    // Exact for convex bodies (separating axes: Gottschalk 1996), also for boxes that hold the eye or reach
    // behind it; where rounding makes it a question, the answer is yes. An empty box is never seen.
    bool intersects(const BoxD& box) const;

    // Perspective: how near along the view direction the part of the box in the pyramid comes, to rounding:
    // its nearest corner after clipping (Sutherland, Hodgman 1974). 0 if the box holds the eye; of a box
    // outside, the box's own nearest.
    double nearestDistance(const BoxD& box) const;

  private:
    bool separates(Vec3d axis, Vec3d centre, Vec3d half) const;

    ViewTransform view_;
    std::array<Vec3d, 4> rays_; // perspective: directions through the corners
    std::vector<Vec3d> axes_;   // perspective: the first four are the pyramid's sides, their normals inwards
};

// How large a sphere shows: its radius in pixels (radius / (slope × distance) × height / 2); infinite if the
// eye is inside it. Never smaller for a sphere around another one.
double projectedPixels(const ViewTransform& view, int height, Vec3d centre, double radius);

} // namespace stipple
