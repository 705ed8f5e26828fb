// Thins the points of one node to a minimum distance, greedily in the order given: the same points in the
// same order leave the same ones. Distances are those of the integers' differences times the scale (0 for an
// axis that does not count).
#pragma once

#include "shared/base/result.hpp"
#include "shared/base/work_gate.hpp"
#include "shared/geometry/vec3.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stipple {

// Indices of the points kept, ascending. `distance` > 0, in the units of `scale`. `corner`: no point has a
// smaller coordinate; none is 2^52 steps or more away from it. Expected time and memory: linear. `cancelled`
// once the gate is closed.
Result<std::vector<std::uint32_t>> thinned(std::span<const Vec3i> points, Vec3i corner, Vec3d scale,
                                           double distance, const WorkGate* gate = nullptr);

} // namespace stipple
