// How a box lies to a region. In the order of how much of it lies inside: to two regions together as to the
// one that it lies worse to.
#pragma once

#include <cstdint>

namespace stipple {

enum class Overlap : std::uint8_t { none, partial, whole };

} // namespace stipple
