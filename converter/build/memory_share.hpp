// How much memory and disk points may take.
#pragma once

#include "shared/base/result.hpp"

#include <cstdint>
#include <string>

namespace stipple {

// Less is not worth asking for.
inline constexpr std::uint64_t leastMemoryBytes = std::uint64_t{1} << 26;

// What was asked for; a quarter of the machine's memory if that is 0.
std::uint64_t memoryForPoints(std::uint64_t requestedBytes);

// Before work starts: that what does not fit memory fits the disk of `folder`. writeFailed if it won't.
Status refuseFullDisk(std::uint64_t pointBytes, std::uint64_t memoryBytes, const std::string& folder);

} // namespace stipple
