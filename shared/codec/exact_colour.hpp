// The exact colours of a node whose picture shows others (docs/FORMAT.md, "Exact colour"): per channel what
// they differ from those, or the values themselves where that is shorter.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"
#include "shared/base/work_gate.hpp"
#include "shared/codec/colour_codec.hpp"

#include <cstdint>
#include <span>

namespace stipple {

// Both of all the node's points in Morton order, `channels` (1 or 3) interleaved; `width`: the narrowest of
// the exact ones.
void writeExactColour(ByteWriter& to, std::span<const std::uint16_t> exact,
                      std::span<const std::uint16_t> shown, int channels, ColourWidth width);

// Replaces the shown colours by the exact ones. `order` is of all the node's points, in an order of the
// caller's: the i-th is order[i]-th in Morton order. `colours` are of them, or of the first of them only.
// Errors: truncated, corrupt; cancelled once the gate is closed. Memory: 8 bytes a point.
Status readExactColour(ByteReader& from, std::span<const std::uint32_t> order, int channels,
                       std::span<std::uint16_t> colours, const WorkGate* gate = nullptr);

} // namespace stipple
