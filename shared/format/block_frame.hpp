// The frame around each block of a file (docs/FORMAT.md, "Blocks"): u32 payload bytes, u32 checksum (low
// half of XXH64 of the payload), payload, padding. A block of no bytes has no frame.
//
// Blocks of nodes of 2048 bytes and more are padded with zeros to a multiple of 16, which costs 1/2000 of
// them and makes the hierarchy, where their sizes are, a fifth smaller.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <string>

namespace stipple {

inline constexpr std::size_t blockFrameBytes = 8;

inline constexpr std::uint64_t paddedFrom = 2048;
inline constexpr std::uint64_t paddedTo = 16;

// For less than 2^32 - 24 bytes; callers have checked.
Bytes frameBlock(ByteSpan payload);       // without padding
Bytes framePaddedBlock(ByteSpan payload); // with
// The payload of a block that fills `block` exactly. `name` says in errors which block it is, `offsetBytes`
// where it starts in the file. Errors: truncated, corrupt.
Result<ByteSpan> unframeBlock(ByteSpan block, const std::string& name, std::uint64_t offsetBytes);

} // namespace stipple
