// Which of a point's two neighbours in Morton order predicts its values: told by the keys alone, so the
// decoder knows it as well.
#pragma once

#include <cstdint>
#include <span>

namespace stipple {

// Bytes that select by masking: the lower neighbour's value is a, the upper one's b.
//   mean: (a + b + 1) / 2   lower: a   upper: b
enum class NeighbourChoice : std::uint8_t { mean = 0, lower = 1, upper = 2 };
using NeighbourChoices = std::span<const NeighbourChoice>; // one for each point of a stratum

// `below` and `above`: differences of the point's key to those of its neighbours, both < 2^63. One
// neighbour alone counts if it is more than 4 times nearer.
inline NeighbourChoice chooseNeighbour(std::uint64_t below, std::uint64_t above) {
    int lower = below < above / 4, upper = above < below / 4;
    return static_cast<NeighbourChoice>(lower + 2 * upper);
}

} // namespace stipple
