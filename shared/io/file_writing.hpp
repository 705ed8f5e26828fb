// What files that are written have in common (POSIX).
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <cstdint>
#include <string>

namespace stipple {

// Writes all bytes from `offset` on. False with errno set if the system refused; some of them may be written.
bool writeFully(int descriptor, std::uint64_t offset, ByteSpan bytes);

// writeFailed with what errno says, and what to do about it: `whereElse` ("write elsewhere") if the disk is
// full.
Error writeFailure(const char* what, const std::string& path, const char* whereElse);

} // namespace stipple
