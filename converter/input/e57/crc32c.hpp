// CRC-32C (Castagnoli; RFC 3720 §12.1, appendix B.4), which guards every page of an E57 file.
#pragma once

#include "shared/base/bytes.hpp"

namespace stipple::e57 {

// With the processor's own instruction where it has one (SSE 4.2): about 8 GB/s instead of 2.
std::uint32_t crc32c(ByteSpan bytes);

// By tables, on any processor; the same values.
std::uint32_t crc32cByTable(ByteSpan bytes);

} // namespace stipple::e57
