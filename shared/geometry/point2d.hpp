// A place in the plane.
#pragma once

namespace stipple {

struct Point2d {
    double x = 0, y = 0;
    friend bool operator==(const Point2d&, const Point2d&) = default;
};

} // namespace stipple
