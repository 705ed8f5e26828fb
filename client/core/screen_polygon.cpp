#include "client/core/screen_polygon.hpp"

namespace stipple {

ScreenPolygon screenPolygon(const ViewTransform& view, int width, int height,
                            std::span<const Point2d> corners) {
    ScreenPolygon polygon;
    bool isPerspective = view.projection == Projection::perspective;
    if (isPerspective)
        polygon.eye = view.eye;
    polygon.forward = view.forward;
    // Far away, where the rounding of world coordinates turns a ray least.
    double depth = isPerspective ? view.far : 0;
    double half = isPerspective ? view.tanHalfFovY * depth : view.halfHeight;
    for (Point2d corner : corners) {
        double right = (2 * corner.x - width) / height * half, up = (height - 2 * corner.y) / height * half;
        polygon.corners.push_back(view.eye + view.forward * depth + view.right * right + view.up * up);
    }
    return polygon;
}

} // namespace stipple
