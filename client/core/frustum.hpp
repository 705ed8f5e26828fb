// What a view sees of boxes and spheres, in double precision, relative to its eye.
#pragma once

#include "client/core/frame_plan.hpp"
#include "shared/geometry/box.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace stipple {

// Of a box: no part of it can be seen; some; all, so that everything within it can, too.
enum class Sight : std::uint8_t { outside, crossing, inside };

// The space that a view shows: in perspective the pyramid from the eye through the picture's corners, in
// orthographic views the prism over the picture; both without an end (near and far enclose the content).
class Frustum {
  public:
    explicit Frustum(const ViewTransform& view);

    // Exact for convex bodies (separating axes: Gottschalk 1996), also for boxes that hold the eye or reach
    // behind it; where rounding makes it a question, the answer is yes. An empty box is never seen.
    Sight sightOf(const BoxD& box) const;
    bool intersects(const BoxD& box) const { return sightOf(box) != Sight::outside; }

    // Perspective: how near along the view direction the part of the box in the pyramid comes, to rounding:
    // its nearest corner after clipping (Sutherland, Hodgman 1974). 0 if the box holds the eye; of a box
    // outside, the box's own nearest. Quick if the sight of the box is known to be `inside`.
    double nearestDistance(const BoxD& box, Sight sight = Sight::crossing) const;

  private:
    // A direction, and where along it what is seen lies: in [low, high], both from the eye.
    struct Axis {
        Vec3d direction;
        double length, low, high;
    };
    static constexpr std::size_t sides = 4;

    void addAxis(Vec3d direction);
    double ownNearest(Vec3d low, Vec3d high) const;

    ViewTransform view_;
    std::array<Vec3d, 4> rays_; // perspective: directions through the corners
    // The first four (orthographic: two) bound what is seen: perspective: the pyramid's sides, normals
    // inwards.
    std::vector<Axis> axes_;
};

// How large a sphere shows: its radius in pixels (radius / (slope × distance) × height / 2); infinite if the
// eye is inside it. Never smaller for a sphere around another one.
double projectedPixels(const ViewTransform& view, int height, Vec3d centre, double radius);

} // namespace stipple
