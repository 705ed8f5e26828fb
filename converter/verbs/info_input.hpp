// `stipple info` of an input of any kind: what convert would make of it.
#pragma once

#include "shared/base/result.hpp"

#include <string>

namespace stipple {

// Reads what openInput reads: headers, or the whole file where those do not state counts and bounds.
Status printInputInfo(const std::string& path, bool json);

} // namespace stipple
