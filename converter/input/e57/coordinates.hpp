// Where a record's point is: its coordinates' fields, and the way from them to the world (ASTM E2807-11
// §8.4.4.1, §8.4.12).
#pragma once

#include "converter/input/common_grid.hpp"
#include "converter/input/e57/records.hpp"
#include "converter/input/point_input.hpp"

namespace stipple::e57 {

struct CoordinateFields {
    bool spherical = false;
    std::array<std::size_t, 3> axes{}; // x, y, z; or range, azimuth, elevation
    int invalidState = -1;             // field that is not 0 where a point is none; -1: all are points

    std::vector<std::size_t> all() const;
};

// Cartesian where a record has both. `corrupt` where it has neither.
Result<CoordinateFields> coordinateFields(const ScanEntry& scan);

// Farther from the origin no point is taken for one: with a grid over it nearer ones could not be told apart.
inline constexpr double farthestCoordinate = 1e15;
// Grid integers beyond this are too wide for any root cube.
inline constexpr std::int64_t farthestInteger = std::int64_t{1} << 52;

// The records of a run that are points. Those that are not are counted in `report`.
struct Kept {
    std::vector<std::uint32_t> rows; // ascending
    std::vector<Vec3d> local, world; // of the rows; only of placements by numbers
    std::vector<Vec3i> positions;    // of the rows
};

// Where the scans' coordinates are multiples of steps and no scan is rotated, one grid may hold all exactly.
// Nothing where none does.
struct ExactGrid {
    Grid grid;
    std::vector<GridMap> maps; // of each scan, from its stored integers
};
std::optional<ExactGrid> exactGrid(const std::vector<const ScanEntry*>& scans,
                                   const std::vector<CoordinateFields>& fields);

// Whether no stored integer of the scan is farther out than any grid could count.
bool allInRange(const ScanEntry& scan, const CoordinateFields& fields, const GridMap& map);

// Positions by integers alone.
void placeExactly(const CoordinateFields& fields, const GridMap& map, const std::vector<Column>& columns,
                  std::size_t count, Kept& kept, ReadReport& report);

// Coordinates as numbers, in the scan's frame and in the world.
void locate(const ScanEntry& scan, const CoordinateFields& fields, const std::vector<Column>& columns,
            std::size_t count, Kept& kept, ReadReport& report);
// After locate(): the nearest integers of `grid`; notes how far they are from the numbers.
void roundToGrid(const Grid& grid, Kept& kept, ReadReport& report);

// The coarsest step that tells the scan's coordinates apart (input/float_grid.hpp): of floats by their
// spacing at the box's farthest corner, of scaled integers at most half of their step.
double finestStep(const ScanEntry& scan, const CoordinateFields& fields, const BoxD& local);

} // namespace stipple::e57
