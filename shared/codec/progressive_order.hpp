// The progressive order of a node's points (docs/FORMAT.md, "Order").
//
// Points are first sorted by their Morton key; `i` is a point's index there, its *Morton index*. Strata are
// taken from that order: stratum 0 holds i = 0, 8, 16, …; stratum 1 i = 4, 12, …; stratum 2 i = 2, 6, …;
// stratum 3 the odd ones. Inside a stratum of m points the j-th in Morton order comes at the place of
// its bit-reversed index: with b = bit length of m - 1, ascending t = 0 … 2^b - 1 gives j = reverse_b(t),
// leaving out j >= m. So each prefix of the whole is spread evenly over the node.
#pragma once

#include "shared/base/work_gate.hpp"
#include "shared/format/node_entry.hpp"

#include <cstdint>
#include <vector>

namespace stipple {

inline std::uint32_t stratumPoints(std::uint32_t pointCount, int stratum) {
    return strataPrefixPoints(pointCount, stratum + 1) - strataPrefixPoints(pointCount, stratum);
}
// Morton index of the j-th point of a stratum: first + j × step.
inline std::uint32_t stratumFirst(int stratum) {
    return stratum == 0 ? 0 : 8u >> stratum;
}
inline std::uint32_t stratumStep(int stratum) {
    return stratum == 0 ? 8 : 16u >> stratum;
}

// The indices 0 … count - 1 in bit-reversed order.
std::vector<std::uint32_t> bitReversedOrder(std::uint32_t count);
// Morton index of each place of the progressive order.
std::vector<std::uint32_t> progressiveOrder(std::uint32_t pointCount);
// The same; `cancelled` once the gate is closed.
Result<std::vector<std::uint32_t>> bitReversedOrder(std::uint32_t count, const WorkGate* gate);
Result<std::vector<std::uint32_t>> progressiveOrder(std::uint32_t pointCount, const WorkGate* gate);

} // namespace stipple
