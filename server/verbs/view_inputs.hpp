// Scans made ready for viewing: each that is no .stipple file is converted, once.
#pragma once

#include "shared/base/result.hpp"

#include <atomic>
#include <functional>
#include <string>

namespace stipple::server {

// Where the converted form of `scan` goes: beside it, or, where that folder can't be written, into a folder
// of this user's under the system's one for temporary files. scan.las becomes scan.stipple; if that exists
// and was made of anything else (of scan.laz, of several scans), scan.las.stipple. Errors: ioFailed.
Result<std::string> convertedPath(const std::string& scan);

// True if `converted` is a cloud of this scan alone, of its size, and at least as new.
bool isUpToDate(const std::string& converted, const std::string& scan);

// The path to serve for `input`: itself if it is a folder, a .stipple file or an address, else what it was
// converted to (now, or before if that is newer). Errors: notFound, what the converter says.
Result<std::string> prepareInput(const std::string& input, const std::atomic<bool>& stop);

} // namespace stipple::server
