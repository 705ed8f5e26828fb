// A node's points, decoded. Order is always the *progressive order*: strata one after the other, and inside
// a stratum by bit-reversed Morton index, so that any prefix is spread evenly over the node. A point's
// index in this order is its identity: picking answers (node, index).
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/geometry/vec3.hpp"

#include <cstdint>
#include <vector>

namespace stipple {

struct NodePicture {
    // In-node coordinates, in grid steps from the node's minimum corner; each < 2^31.
    std::vector<Vec3<std::uint32_t>> positions;
    // rgb: three u16 a point, interleaved; intensity: one u16 a point; none: empty.
    std::vector<std::uint16_t> colour;

    std::size_t size() const { return positions.size(); }
};

} // namespace stipple
