// Text files of points as inputs: XYZ, TXT, CSV and PTS. A line is a point; empty lines and comments (# and
// //) are passed over.
//
// Separators (blanks, tabs, commas, semicolons, bars) and the decimal sign are guessed from the first lines,
// columns are named by InputOptions::columns, by a header line, or guessed from their number and values; what
// was guessed is said in a warning and in SourceFile::format. Coordinates are calculated with as decimals:
// the grid's step is the last decimal that one of them has, so nothing is rounded (input/float_grid.hpp).
//
// PTS: a line with a number of points, then lines "x y z intensity red green blue"; several such may follow
// each other. Intensities from -2048 to 2047 become 0 to 4095.
#pragma once

#include "converter/input/shared_source.hpp"
#include "converter/input/table.hpp"

namespace stipple {

// The first lines look like points; `start` is the beginning of a file, cut anywhere. `anyHeader`: lines
// before them may say anything.
bool looksLikeText(std::string_view start, bool anyHeader = false);

Result<std::unique_ptr<PointInput>>
openTextInput(const std::string& path, std::unique_ptr<SharedSource> source, const InputOptions& options);

} // namespace stipple
