// The exact colours of a node whose picture shows others (docs/FORMAT.md, "Exact colour"): per channel what
// they differ from those, or the values themselves where that is shorter.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <cstdint>
#include <span>

namespace stipple {

// Both of all the node's points in Morton order, `channels` (1 or 3) interleaved.
void writeExactColour(ByteWriter& to, std::span<const std::uint16_t> exact,
                      std::span<const std::uint16_t> shown, int channels);

// Replaces the shown colours by the exact ones. `colours` are in an order of the caller's: its i-th point is
// order[i]-th in Morton order. Errors: truncated, corrupt. Memory: 8 bytes a point.
Status readExactColour(ByteReader& from, std::span<const std::uint32_t> order, int channels,
                       std::span<std::uint16_t> colours);

} // namespace stipple
