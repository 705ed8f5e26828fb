// The cloud's one integer grid: world = offset + scale × integer, per axis, as in LAS 1.4 §2.4
// ("X/Y/Z scale factor", "offset"). Points keep their integers exactly; world coordinates are derived.
#pragma once

#include "shared/geometry/vec3.hpp"

namespace stipple {

struct Grid {
    Vec3d scale{0.001, 0.001, 0.001}; // world units per step, > 0
    Vec3d offset{0, 0, 0};            // world position of integer 0

    Vec3d toWorld(Vec3i p) const {
        return {offset.x + scale.x * static_cast<double>(p.x), offset.y + scale.y * static_cast<double>(p.y),
                offset.z + scale.z * static_cast<double>(p.z)};
    }
    // A world position in steps, not rounded.
    Vec3d toSteps(Vec3d world) const {
        return {(world.x - offset.x) / scale.x, (world.y - offset.y) / scale.y,
                (world.z - offset.z) / scale.z};
    }
    friend bool operator==(const Grid&, const Grid&) = default;
};

} // namespace stipple
