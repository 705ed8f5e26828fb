// One attribute of all points of a node, of any type and number of components (docs/FORMAT.md,
// "Attributes"). Values are bit patterns: a NaN comes back as the very NaN that went in.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"
#include "shared/base/work_gate.hpp"

namespace stipple {

// `values` in Morton order: per point `components` values of `width` bytes (1, 2, 4 or 8), little-endian.
// Each component is written in whichever way is smallest.
void encodeColumn(ByteWriter& to, ByteSpan values, std::size_t width, std::size_t components);

// Decodes `pointCount` points; the caller has bounded the count. Errors: truncated, corrupt; cancelled once
// the gate is closed.
Result<Bytes> decodeColumn(ByteReader& from, std::size_t pointCount, std::size_t width,
                           std::size_t components, const WorkGate* gate = nullptr);

} // namespace stipple
