// PTX files as inputs (Leica Cyclone): one or more scans, each with its own pose.
//
//   columns                    each on a line of its own
//   rows
//   x y z                      where the scanner stood
//   x y z (3 lines)            its axes
//   a b c d (4 lines)          the pose: (x y z 1) × matrix is the point in the common frame
//   x y z intensity [r g b]    columns × rows lines; "0 0 0" is a direction without a point
//
// Points are given in the common frame, calculated in double; the grid's step is the last decimal that a
// coordinate or a translation has. "0 0 0" is left out and counted as invalid. Intensities from 0 to 1 become
// Intensity, 0 to 65535. "Point Source ID" is the number of the scan in the file, from 1.
#pragma once

#include "converter/input/shared_source.hpp"
#include "converter/input/table.hpp"

#include <string_view>

namespace stipple {

// The header of a first scan; `start` is the beginning of a file, cut anywhere behind its tenth line.
bool looksLikePtx(std::string_view start);

Result<std::unique_ptr<PointInput>>
openPtxInput(const std::string& path, std::unique_ptr<SharedSource> source, const InputOptions& options);

} // namespace stipple
