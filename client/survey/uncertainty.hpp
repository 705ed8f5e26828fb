// How far a result may be off because the points that were picked are not quite the places that were meant: a
// scan has a point only every so often.
#pragma once

#include "shared/geometry/vec3.hpp"

#include <functional>
#include <span>
#include <vector>

namespace stipple::survey {

// Standard deviation, an axis, of a picked point about the place that was meant, if points are `spacing`
// apart there: of a place that is equally likely anywhere within half a spacing.
double deviationOfSpacing(double spacing);

// Of what a measure says of the points.
using Measure = std::function<double(std::span<const Vec3d>)>;

// Standard deviation of measure(points), each coordinate of point i being off by deviations[i] independently
// of the others: first-order propagation (JCGM 100:2008, "Guide to the expression of uncertainty in
// measurement", §5.1.2), its derivatives taken over the deviations themselves.
double uncertaintyOf(const Measure& measure, std::span<const Vec3d> points,
                     std::span<const double> deviations);

} // namespace stipple::survey
