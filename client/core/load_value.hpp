// What further points of a node add to the picture: the area, in square pixels, that they are to stand for
// where they show. Divided by the bytes that they take, it says what to ask for first.
//
// A node's points stand for areas as wide as the spacing of the first that is missing (rank_density.hpp), so
// coarse nodes, and coarse strata of a node, are worth most. As in ExpectedPoints they are taken as spread
// evenly over 27 cells of the node's box, and a cell whose middle is out of the picture adds nothing.
//
// What is near hides what is far; how much of it is not known, but of two nodes that add the same area the
// nearer one shows more. So values fall with the square root of the distance (of exponents 0, 1/4, 1/2 and 1
// that with the fewest bytes to 5 % error over a scan, a town and an interior: docs/MEASUREMENTS.md).
#pragma once

#include "client/core/frame_plan.hpp"
#include "client/core/hierarchy.hpp"

#include <cstdint>

namespace stipple {

// Of the points of rank `from` to `to` - 1; `height`: of the picture, pixels. Greater than 0 for a node that
// is in view (whatever of it is).
double loadValue(const ViewTransform& view, int height, const Hierarchy& hierarchy, std::size_t node,
                 std::uint32_t from, std::uint32_t to);

} // namespace stipple
