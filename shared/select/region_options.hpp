// Regions as users state them: numbers on a command line or in an address, made parts of a filter.
#pragma once

#include "shared/base/result.hpp"
#include "shared/select/point_filter.hpp"

#include <memory>
#include <span>

namespace stipple {

// A box that is turned: its centre and full sizes along its own axes, either x, y, z or x, y (any height);
// and its rotation, degrees counter-clockwise about z, or (for boxes with a height) a quaternion x, y, z, w,
// of any length. No rotation: none. Errors (invalidArgument): `where` is "center", "size" or "rotation".
Result<std::shared_ptr<const ConvexRegion>>
rotatedBox(std::span<const double> centre, std::span<const double> size, std::span<const double> rotation);

// Closed; together with what the filter's box says of z.
void limitHeights(PointFilter& filter, ValueRange heights);

} // namespace stipple
