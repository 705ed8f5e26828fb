// Damages a file the way disks, networks and attackers do. The same seed damages it the same way.
#pragma once

#include "shared/base/bytes.hpp"

#include <cstdint>
#include <string>

namespace stipple::test {

struct Mutation {
    Bytes bytes;
    std::string what;             // "byte 17: bit 3 flipped"
    std::size_t firstTouched = 0; // bytes before this one are as they were
    std::size_t endTouched = 0;   // bytes from here on are as they were, if the size is the same
    bool sameSize = true;
};

Mutation mutate(const Bytes& original, std::uint64_t seed);

} // namespace stipple::test
