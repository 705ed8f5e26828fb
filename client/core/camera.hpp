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
    // The direction that is up on the screen, as a hint, and the axis that orbit() turns around: need not be
    // perpendicular. Where it is parallel to the direction, +y takes its place (or +z, looking along y).
    Vec3d up{0, 0, 1};
    double fovYDegrees = 60;
    double orthoHeight = 10; // orthographic: height of the view in world units

    friend bool operator==(const Camera&, const Camera&) = default;
};

// False if a number is not finite, the field of view is not in (0, 180) degrees or the height not positive.
bool isUsable(const Camera& camera);

// Orthonormal axes and projection for a viewport (pixels, > 0); near and far enclose what is in front of the
// camera of `content` (world units). A camera inside its content, behind it, or far away from it, an empty
// content and one of a single point all give 0 < near < far.
ViewTransform viewTransform(const Camera& camera, int width, int height, const BoxD& content);

// Where a world point falls: x and y in pixels from the picture's top left corner, z the view distance.
// Only meaningful for z > 0 in perspective.
Vec3d projectToPixels(const ViewTransform& view, int width, int height, Vec3d world);
// World units in one pixel at the depth of the camera's target.
double unitsPerPixel(const Camera& camera, int height);

// The camera that looks the same way and shows all of `content` (empty: the same camera). The corners of
// `content` fill the picture's width or height but for a margin of a fiftieth at each side, and are centred
// in both. `aspect` = width / height.
Camera fittedCamera(const Camera& looking, const BoxD& content, double aspect);

enum class NamedView { top, front, side, iso };
// The fitted camera from that side: `top` looks down with +y up, `front` looks along +y, `side` along -x,
// `iso` along (1, 1, -1).
Camera namedCamera(NamedView view, const BoxD& content, double aspect,
                   Projection projection = Projection::perspective);

// Interaction, each a pure step; dx, dy in pixels (x right, y down), viewport in pixels. A drag moves the
// content with the pointer. A step that would leave what a double can hold is not taken.

// Turns around the target: half a turn per viewport height; stops short of the poles of `up`.
Camera orbit(const Camera& camera, double dx, double dy, int height);
Camera pan(const Camera& camera, double dx, double dy, int height);
// Zooms by `factor` (< 1 nearer) keeping the world point under pixel (x, y) at the target's depth fixed.
Camera zoomTo(const Camera& camera, double factor, double x, double y, int width, int height);

// The camera under the other projection: what lies at the target's depth keeps its size and place. From
// perspective the height of the view changes, to perspective the distance from the target.
Camera withProjection(const Camera& camera, Projection projection);

} // namespace stipple
