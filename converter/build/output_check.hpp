// That an output replaces nothing of value.
#pragma once

#include "shared/base/result.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace stipple {

// Refuses an output that is one of the inputs (invalidArgument, never forced), a folder, in a folder that
// does not exist or can't be written, or, unless `force`, an existing file that does not begin with `magic`
// (writeFailed).
Status checkOutput(const std::vector<std::string>& inputs, const std::string& output, bool force,
                   std::string_view magic);

} // namespace stipple
