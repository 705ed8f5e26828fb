// The camera of the reference renderer: from the camera's definition (client/core/camera.hpp) to pixels, in
// its own arithmetic. Differences between world coordinates are taken in long double (64 bits of mantissa on
// x86), so that an offset of 10^12 leaves no trace; what follows is double.
#pragma once

#include "client/core/camera.hpp"

#include <limits>

namespace stipple::reference {

using Vec3l = Vec3<long double>;

struct View {
    int width = 0, height = 0; // pixels
    Projection projection = Projection::perspective;
    Vec3d right, up, forward; // unit vectors
    Vec3l eye;                // where distances start
    double pixelsPerUnit = 1; // perspective: at distance 1; orthographic: anywhere
    // Points outside this range of distances are not drawn. Behind the eye there is nothing to see.
    double near = 0, far = std::numeric_limits<double>::infinity();

    double pixelsPerUnitAt(double distance) const {
        return projection == Projection::perspective ? pixelsPerUnit / distance : pixelsPerUnit;
    }
};

// `camera` is usable (isUsable). `content`: bounds of everything that is drawn; an orthographic view starts
// its distances where all of it lies in front, and no nearer to the target than a perspective camera that
// sees the target at the same size.
View viewOf(const Camera& camera, int width, int height, const BoxD& content);

struct Place {
    double x = 0, y = 0; // pixels from the picture's top left corner
    double distance = 0; // along `forward`
};
// False if the point is not in front, or out of range.
bool place(const View& view, const Vec3l& world, Place& at);

} // namespace stipple::reference
