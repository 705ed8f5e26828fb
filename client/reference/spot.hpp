// What a place in the picture has to do with a mark: the shapes of points.
#pragma once

#include "client/reference/marks.hpp"

namespace stipple::reference {

// How far a mark might be off, for pictures that are compared pixel by pixel.
struct Slack {
    double pixels = 0.01;
    double levels = 2;      // splats: how much the mean may move with its weights
    double distance = 4e-6; // relative: 2^-18, the coarsest depth step of a range of 32 octaves
    double radians = 1e-4;  // discs: of their normals
};

struct Spot {
    double inside = 0; // how far inside the mark it lies, pixels; > 0 inside. Discs: exact in its sign alone,
                       // and smaller than the slack, either way, where that decides
    double away = 0;   // from the mark's middle, pixels of it; on the disc, for discs
    double distance = 0; // view distance of the mark there
    double spread = 0;   // world units that the distance may change by with the slack
    double wander = 0;   // pixels that `away` may
};

// (dx, dy): from the mark's middle, pixels, y down. `slack`: null where only the picture is wanted.
Spot spotOf(const Mark& mark, double dx, double dy, PointShape shape, const Slack* slack);

// No place that is farther from the mark's middle, along an axis, is inside it; pixels.
double reachOf(const Mark& mark, PointShape shape);

} // namespace stipple::reference
