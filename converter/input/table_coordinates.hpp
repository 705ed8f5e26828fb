// Coordinates of rows as integers of a grid.
#pragma once

#include "converter/input/table_measure.hpp"
#include "shared/geometry/grid.hpp"

namespace stipple {

// Text is calculated with as decimals: where the grid's step is a power of ten no coordinate passes through a
// binary number, and what the grid can hold is held exactly.
class CoordinateScale {
  public:
    CoordinateScale() = default;
    explicit CoordinateScale(const Grid& grid);

    // The nearest integers; grows `maxRounding` by the distances to them.
    std::int64_t toGrid(int axis, double coordinate, double& maxRounding) const;
    std::int64_t toGrid(int axis, const Number& coordinate, double& maxRounding) const;
    // Of value × 10^-decimals.
    std::int64_t toGrid(int axis, __int128 value, int decimals) const;

  private:
    Grid grid_;
    bool decimal_ = false;
    int decimals_ = 0;                 // of the step
    std::array<__int128, 3> offset_{}; // in steps
};

// The positions of `rows` (points only).
void convertPositions(const Table& table, const CoordinateScale& scale, const Rows& rows, Vec3i* positions,
                      double& maxRounding);

// The nearest double to value × 10^-decimals.
double decimalToDouble(__int128 value, int decimals);

} // namespace stipple
