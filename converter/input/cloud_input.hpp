// A `.stipple` file as an input: what `convert --append` adds to, and clouds to be joined.
#pragma once

#include "converter/input/point_input.hpp"

namespace stipple {

// Every node is a part. Positions and attributes are those the cloud was made of, exactly.
Result<std::unique_ptr<PointInput>> openCloudInput(const std::string& path);

} // namespace stipple
