// The one grid of a cloud made from inputs with several.
//
// Scales and offsets are decimal numbers somebody wrote ("0.001"), so they are taken as the shortest decimal
// that reads back as the same double, and calculated with exactly. The grid's step is the greatest common
// divisor of all scales and of all differences of offsets: the coarsest grid, on each axis, that holds every
// input's points exactly. If that would be more than 1000 times finer than the finest input (offsets with
// stray digits), the finest scale is kept and points are rounded to it; and if the inputs would reach over
// more than 2^52 steps of that, ten times it, and so on.
#pragma once

#include "shared/geometry/box.hpp"
#include "shared/geometry/grid.hpp"

#include <array>
#include <vector>

namespace stipple {

// From one input's integers to the cloud's, on one axis.
struct AxisMap {
    bool exact = true;
    std::int64_t multiply = 1, add = 0; // exact: cloud = multiply × input + add
    double factor = 1, shift = 0;       // else: cloud = round(factor × input + shift)

    bool isIdentity() const { return exact && multiply == 1 && add == 0; }
    std::int64_t toCloud(std::int64_t input) const;
    // How far toCloud(input) lies from where it should, in steps of the cloud's grid (told to a millionth of
    // a step for integers of 32 bits; to a step for those of 52).
    double errorSteps(std::int64_t input) const;
};

struct GridMap {
    std::array<AxisMap, 3> axes;

    bool isIdentity() const { return axes[0].isIdentity() && axes[1].isIdentity() && axes[2].isIdentity(); }
    bool isExact() const { return axes[0].exact && axes[1].exact && axes[2].exact; }
    Vec3i toCloud(Vec3i p) const {
        return {axes[0].toCloud(p.x), axes[1].toCloud(p.y), axes[2].toCloud(p.z)};
    }
};

// Does not depend on the order of `grids` (at least one; scales finite and > 0, offsets finite). `boxes`:
// where the points of each lie, in integers of its own grid, as far as that is known; as many as grids, or
// none.
Grid commonGrid(const std::vector<Grid>& grids, const std::vector<BoxI>& boxes = {});

// From points on `from` to points on `to`; exact wherever `to` can hold them exactly.
GridMap gridMap(const Grid& from, const Grid& to);

} // namespace stipple
