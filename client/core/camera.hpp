// The camera: where it is, where it looks, how it projects. World coordinates in double; the frame plan
// turns them into integers per node.
#pragma once

#include "client/core/frame_plan.hpp"
#include "shared/geometry/box.hpp"
#include "shared/geometry/vec3.hpp"

namespace stipple {

struct Camera {
    Projection projection = Projection::perspective;
    Vec3d position{0, -10, 0};
    Vec3d target{0, 0, 0}; // orbit centre; the view direction is target - position
    Vec3d up{0, 0, 1};     // hint; need not be perpendicular, must not be parallel to the direction
    double fovYDegrees = 60;
    double orthoHeight = 10; // orthographic: height of the view in world units

    friend bool operator==(const Camera&, const Camera&) = default;
};

// Orthonormal axes and projection for a viewport; near and far enclose `content` (world units).
ViewTransform viewTransform(const Camera& camera, int width, int height, const BoxD& content);

enum class NamedView { top, front, iso };
// A camera that shows all of `content` from that side. `aspect` = width / height.
Camera namedCamera(NamedView view, const BoxD& content, double aspect,
                   Projection projection = Projection::perspective);

// Interaction, each a pure step; dx, dy in pixels (x right, y down), viewport in pixels.
Camera orbit(const Camera& camera, double dx, double dy, int height);
Camera pan(const Camera& camera, double dx, double dy, int height);
// Zooms by `factor` (< 1 nearer) keeping the world point under pixel (x, y) at the target's depth fixed.
Camera zoomTo(const Camera& camera, double factor, double x, double y, int width, int height);

} // namespace stipple
