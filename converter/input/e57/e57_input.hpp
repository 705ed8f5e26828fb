// E57 files (ASTM E2807-11) as inputs: the points of all their scans (data3D), in the file's common frame.
//
// Cartesian and spherical coordinates; poses applied in double. The grid is that of the coordinates where
// they are integers with a step and no scan is rotated, and all scans have a common one; then positions are
// exact. Else the points are read once at opening, and the grid is the finest that floats of their
// size can tell apart (input/float_grid.hpp). Points that the file marks as invalid are dropped and counted.
// What records hold besides is in input/e57/attributes.hpp. Pictures (images2D) are left out.
#pragma once

#include "converter/input/open.hpp"

namespace stipple {

// `scale` > 0: the grid's step where it is not exact. Parts begin about every quarter of a million records.
// Errors name the file and the byte; a page with a wrong checksum is never read past.
Result<std::unique_ptr<PointInput>> openE57Input(const std::string& path, const InputOptions& options = {});

} // namespace stipple
