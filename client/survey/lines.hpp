// Distances, heights, azimuths and angles along points that were picked. Points are local (exact_points.hpp),
// lengths in the cloud's unit, angles in degrees.
#pragma once

#include "client/survey/directions.hpp"

#include <optional>
#include <span>
#include <vector>

namespace stipple::survey {

struct Segment {
    double distance = 0;            // in space
    double horizontal = 0;          // in plan
    double vertical = 0;            // end less start; > 0: upwards
    std::optional<double> azimuth;  // clockwise from grid north, [0, 360); none: vertical, or no length
    std::optional<double> gradient; // above the horizontal, -90..90; none: no length
};

Segment measureSegment(Vec3d from, Vec3d to, const Directions& directions = {});

struct Line {
    std::vector<Segment> segments;
    double distance = 0, horizontal = 0; // sums
    double vertical = 0;                 // last less first
    double ascent = 0, descent = 0;      // sums of the vertical parts that go up, and down; both >= 0
    double lowest = 0, highest = 0;      // of the points' heights, above the first
    double height() const { return highest - lowest; }
};

// `closed`: a segment leads from the last point back to the first.
Line measureLine(std::span<const Vec3d> points, const Directions& directions = {}, bool closed = false);

// Between the ways from `corner` to `a` and to `b`, 0..180; none if one of them has no length. Full precision
// also near 0 and 180, where an arc cosine has half the digits (Kahan, "How Futile are Mindless Assessments
// of Roundoff", §12).
std::optional<double> angleAt(Vec3d corner, Vec3d a, Vec3d b);

} // namespace stipple::survey
