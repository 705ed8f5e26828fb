// PCD files as inputs (Point Cloud Library), versions 0.5 to 0.7: ASCII, binary and compressed.
//
// VIEWPOINT is the pose the sensor had; PCL does not apply it to points, and neither is it here. Packed
// colours (rgb, rgba) become Red, Green and Blue. Points whose coordinates are NaN, as organised clouds have,
// are left out and counted.
#pragma once

#include "converter/input/shared_source.hpp"
#include "converter/input/table.hpp"

namespace stipple {

// Compressed files are decoded once when they are opened, to note 8 KiB a field for each part (under 2 % of
// what they hold), so that parts can be entered.
Result<std::unique_ptr<PointInput>>
openPcdInput(const std::string& path, std::unique_ptr<SharedSource> source, const InputOptions& options);

} // namespace stipple
