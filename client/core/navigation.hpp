// Ways to move a camera that know what is under the pointer: about a point, along the ground, towards a
// point, as a person who looks around and walks, and flights from one camera to another. Pure steps beside
// those of camera.hpp, with the same pixels (x right, y down) and the same promise: a step that would leave
// what a double can hold, or whose numbers are not finite, is not taken.
#pragma once

#include "client/core/camera.hpp"

namespace stipple {

// Turns by orbit()'s angles around `pivot`, which stays at its place in the picture.
Camera orbitAbout(const Camera& camera, Vec3d pivot, double dx, double dy, int height);

// Moves over the ground, at the same height, so that `grabbed` comes to lie under pixel (x, y). Where the
// pointer does not meet the ground at that point's height, or only at the horizon (farther than 20 times the
// distance of the point), it moves as dragAtDepth().
Camera dragGround(const Camera& camera, Vec3d grabbed, double x, double y, int width, int height);
// Moves across the view so that `grabbed` comes to lie under pixel (x, y).
Camera dragAtDepth(const Camera& camera, Vec3d grabbed, double x, double y, int width, int height);

// Comes nearer to a point by `factor` (< 1 nearer, > 0): it stays at its place in the picture and is never
// passed.
Camera zoomToPoint(const Camera& camera, Vec3d point, double factor);

// Turns the head: the direction of view follows the content under the pointer, the position stays.
Camera lookAround(const Camera& camera, double dx, double dy, int height);

// Steps in world units. `level`: forward is the horizontal part of the direction of view, as for one who
// walks; else along the view, as for one who flies. Orthographic views come nearer by their height instead.
struct Walk {
    double forward = 0, right = 0, up = 0;
    bool level = false;
};
Camera walk(const Camera& camera, const Walk& step);

// The same view from `part` of the distance, with `point` in the middle.
Camera facing(const Camera& camera, Vec3d point, double part);

// A way from one camera to another that looks smooth: it draws back, passes over, and comes near again, as
// fast in the picture all along (van Wijk and Nuij, "Smooth and efficient zooming and panning", 2003, eq. 8
// and 9, ρ = √2), begins and ends at rest.
class Flight {
  public:
    Flight(const Camera& from, const Camera& to);
    // t in 0..1; 0 is `from` and 1 is `to`, exactly.
    Camera at(double t) const;
    // How long it is: the path's S of the paper, or how far the view turns if that is more; 0: nothing moves.
    double length() const { return length_; }

  private:
    double widthAt(double s) const, shareAt(double s) const;

    Camera from_, to_, arrival_;   // to_ in the projection of from_
    double startWidth_, endWidth_; // of the views at their targets, world units
    double way_;                   // between the targets
    double r0_ = 0, path_ = 0;     // of the paper; its S
    double length_ = 0;
    bool isStraight_; // the targets are the same: the width alone changes
};

} // namespace stipple
