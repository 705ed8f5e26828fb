// A polygon that was drawn on a picture, as what it reaches into in the world.
#pragma once

#include "client/core/frame_plan.hpp"
#include "shared/geometry/point2d.hpp"
#include "shared/geometry/screen_prism.hpp"

#include <span>

namespace stipple {

// `corners`: in pixels from the top left of a picture of that view and size. ScreenPrism::make() says whether
// it is one.
ScreenPolygon screenPolygon(const ViewTransform& view, int width, int height,
                            std::span<const Point2d> corners);

} // namespace stipple
