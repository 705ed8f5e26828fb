// The frame around each block of a file (docs/FORMAT.md, "Blocks"): u32 payload bytes, u32 checksum (low
// half of XXH64 of the payload), payload. A block of no bytes has no frame.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <string>

namespace stipple {

inline constexpr std::size_t blockFrameBytes = 8;

Bytes frameBlock(ByteSpan payload); // invalid for 2^32 - 8 bytes or more; callers have checked
// The payload of a block that fills `block` exactly. `name` says in errors which block it is, `offsetBytes`
// where it starts in the file. Errors: truncated, corrupt.
Result<ByteSpan> unframeBlock(ByteSpan block, const std::string& name, std::uint64_t offsetBytes);

} // namespace stipple
