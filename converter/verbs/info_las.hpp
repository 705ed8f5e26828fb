// `stipple info` of a LAS file: header, records, attributes, warnings. Reads no points.
#pragma once

#include "shared/base/result.hpp"

#include <string>

namespace stipple {

Status printLasInfo(const std::string& path, bool json);

} // namespace stipple
