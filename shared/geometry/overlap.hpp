// How a box lies to a region.
#pragma once

#include <cstdint>

namespace stipple {

enum class Overlap : std::uint8_t { none, partial, whole };

} // namespace stipple
