// Where to stand so that content fills the view: the perspective camera of a given direction that comes
// nearest and still has all points within its view.
#pragma once

#include "shared/geometry/vec3.hpp"

#include <span>

namespace stipple {

// Points and result in the camera's axes: x right, y up, z along the view. A point is within the view where
// |x| <= slopeX × z and |y| <= slopeY × z as seen from the eye; slopes > 0. The points' bounds in the picture
// touch both sides in one direction and are centred in both. The eye stays at least `gap` in front of the
// nearest point. At least one point.
Vec3d fittedEye(std::span<const Vec3d> points, double slopeX, double slopeY, double gap);

} // namespace stipple
