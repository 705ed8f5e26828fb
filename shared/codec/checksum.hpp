// XXH64 (github.com/Cyan4973/xxHash, doc/xxhash_spec.md): fast, no defence against an adversary.
#pragma once

#include "shared/base/bytes.hpp"

namespace stipple {

std::uint64_t xxh64(ByteSpan bytes, std::uint64_t seed = 0);

// What stands in block frames and in the file header: the low 32 bits.
inline std::uint32_t blockChecksum(ByteSpan bytes) {
    return static_cast<std::uint32_t>(xxh64(bytes));
}

} // namespace stipple
