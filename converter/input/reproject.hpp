// An input in another coordinate reference system than it states.
#pragma once

#include "converter/crs/transformation.hpp"
#include "converter/input/point_input.hpp"

namespace stipple {

// The points of `input` transformed to `to`, in double precision, and put on a grid of their own:
//
// * x and y: the largest power of ten that is at most the input's own step, told in the unit of `to` (a
//   degree taken for 111.32 km), so a point moves by at most about half of the step that it came with.
// * z: the input's integers, untouched, where the transformation keeps heights; else as x and y.
// * Offsets as floatGrid's (input/float_grid.hpp).
//
// The description's bounds are those of a lattice of 17 × 17 × 2 places in the input's stated box, widened by
// 1/256: not measured. Points that PROJ can't transform are left out and counted
// (ReadReport::untransformable), so fewer may come than the description and the parts say. Attributes stay as
// they are, directions too. Errors: those of PROJ.
Result<std::unique_ptr<PointInput>> reprojectInput(std::unique_ptr<PointInput> input,
                                                   std::shared_ptr<const CrsTransformation> transformation,
                                                   const Crs& to);

} // namespace stipple
