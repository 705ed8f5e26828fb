// A whole file as text, of what a person hands over as an option.
#pragma once

#include "shared/base/result.hpp"

#include <cstdint>
#include <string>

namespace stipple {

// Errors: those of the file; limitExceeded for more than `most` bytes. `what` begins that sentence: "the
// polygons take".
Result<std::string> readTextFile(const std::string& path, std::uint64_t most, const char* what);

} // namespace stipple
