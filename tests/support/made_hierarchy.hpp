// Hierarchies of any size without points: a terrain of 2^31 × 2^31 steps of 1 mm, each node with the four
// lower children, breadth first until `nodes` are reached. For tests and measurements of the selection.
#pragma once

#include "client/core/hierarchy.hpp"

#include <cstdint>

namespace stipple::test {

struct MadeHierarchyOptions {
    std::size_t nodes = 10'000;
    std::uint32_t pointsPerNode = 10'000;
    int rootBits = 31;
};

// What the options describe; ends the program if the hierarchy refuses it.
Hierarchy makeHierarchy(const MadeHierarchyOptions& options);

} // namespace stipple::test
