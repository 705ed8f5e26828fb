#include "converter/input/e57/coordinates.hpp"

#include "converter/input/float_grid.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace stipple::e57 {

namespace {
constexpr std::array<std::string_view, 3> cartesianNames{"cartesianX", "cartesianY", "cartesianZ"};
constexpr std::array<std::string_view, 3> sphericalNames{"sphericalRange", "sphericalAzimuth",
                                                         "sphericalElevation"};
constexpr int float32Bits = 24, float64Bits = 53, doubleDigits = 15;

// How many of the three a record has; `missing` is the last one that it has not.
int findAll(const ScanEntry& scan, const std::array<std::string_view, 3>& names, CoordinateFields& found,
            std::string_view& missing) {
    int count = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        int field = scan.find(names[axis]);
        if (field < 0 || scan.fields[static_cast<std::size_t>(field)].kind == FieldKind::text) {
            missing = names[axis];
            continue;
        }
        found.axes[axis] = static_cast<std::size_t>(field);
        ++count;
    }
    return count;
}

// The sum of two decimal numbers, without the stray digit that adding them as doubles may bring.
double decimalSum(double a, double b) {
    if (a == 0 || b == 0)
        return a + b;
    char text[40];
    std::snprintf(text, sizeof text, "%.15g", a + b);
    return std::strtod(text, nullptr);
}

// The grid that a scan's stored integers are on, in the world; nothing where they are on none.
std::optional<Grid> gridOf(const ScanEntry& scan, const CoordinateFields& fields) {
    if (fields.spherical || scan.pose.rotates)
        return std::nullopt;
    Grid grid;
    for (int axis = 0; axis < 3; ++axis) {
        const Field& field = scan.fields[fields.axes[static_cast<std::size_t>(axis)]];
        if (!field.isInteger() || !(field.scale > 0))
            return std::nullopt;
        grid.scale[axis] = field.scale;
        grid.offset[axis] = decimalSum(field.offset, scan.pose.translation[axis]);
        if (!std::isfinite(grid.offset[axis]))
            return std::nullopt;
    }
    return grid;
}

// The stored integers whose place on the grid can be counted.
Range countable(const AxisMap& map) {
    double limit = static_cast<double>(farthestInteger), add = static_cast<double>(map.add),
           multiply = static_cast<double>(map.multiply);
    return {std::max(-limit, std::ceil((-limit - add) / multiply)),
            std::min(limit, std::floor((limit - add) / multiply))};
}

bool isMarkedInvalid(const CoordinateFields& fields, const std::vector<Column>& columns, std::size_t i) {
    if (fields.invalidState < 0)
        return false;
    const Column& state = columns[static_cast<std::size_t>(fields.invalidState)];
    return state.integers[i] != 0;
}

// Within 2^53 for a grid over the points; kept defined for points that came into the file since.
std::int64_t nearest(double steps) {
    constexpr double limit = 4e18;
    return static_cast<std::int64_t>(std::clamp(steps + (steps < 0 ? -0.5 : 0.5), -limit, limit));
}
} // namespace

std::vector<std::size_t> CoordinateFields::all() const {
    std::vector<std::size_t> result(axes.begin(), axes.end());
    if (invalidState >= 0)
        result.push_back(static_cast<std::size_t>(invalidState));
    return result;
}

Result<CoordinateFields> coordinateFields(const ScanEntry& scan) {
    CoordinateFields fields;
    std::string_view missing;
    std::string state = "cartesianInvalidState";
    int cartesian = findAll(scan, cartesianNames, fields, missing);
    if (cartesian < 3) {
        std::string_view missingAngle;
        fields.spherical = true;
        state = "sphericalInvalidState";
        int spherical = findAll(scan, sphericalNames, fields, missingAngle);
        if (spherical < 3)
            return Error{
                ErrorCode::corrupt,
                cartesian + spherical == 0
                    ? "its records have no coordinates (neither cartesianX, Y, Z nor sphericalRange, "
                      "Azimuth, Elevation)"
                    : cat("its records have no ", cartesian >= spherical ? missing : missingAngle,
                          ", so its points are nowhere"),
                "", "write the file again with coordinates"};
    }
    int field = scan.find(state);
    if (field >= 0 && scan.fields[static_cast<std::size_t>(field)].isInteger())
        fields.invalidState = field;
    return fields;
}

std::optional<ExactGrid> exactGrid(const std::vector<const ScanEntry*>& scans,
                                   const std::vector<CoordinateFields>& fields) {
    std::vector<Grid> grids;
    for (std::size_t i = 0; i < scans.size(); ++i) {
        auto grid = gridOf(*scans[i], fields[i]);
        if (!grid)
            return std::nullopt;
        grids.push_back(*grid);
    }
    if (grids.empty())
        return std::nullopt;
    ExactGrid exact;
    exact.grid = commonGrid(grids);
    for (const Grid& grid : grids) {
        exact.maps.push_back(gridMap(grid, exact.grid));
        if (!exact.maps.back().isExact())
            return std::nullopt;
    }
    return exact;
}

bool allInRange(const ScanEntry& scan, const CoordinateFields& fields, const GridMap& map) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Field& field = scan.fields[fields.axes[axis]];
        Range range = countable(map.axes[axis]);
        double low = static_cast<double>(field.minimum), high = low + std::ldexp(1.0, field.bits);
        if (low < range.min || high > range.max)
            return false;
    }
    return true;
}

void placeExactly(const CoordinateFields& fields, const GridMap& map, const std::vector<Column>& columns,
                  std::size_t count, Kept& kept, ReadReport& report) {
    kept.rows.resize(count);
    kept.positions.resize(count);
    std::size_t points = 0;
    const bool same = map.isIdentity();
    std::int64_t low[3], high[3];
    const std::int64_t* values[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Range range = countable(map.axes[axis]);
        low[axis] = static_cast<std::int64_t>(range.min);
        high[axis] = static_cast<std::int64_t>(range.max);
        values[axis] = columns[fields.axes[axis]].integers.data();
    }
    for (std::size_t i = 0; i < count; ++i) {
        if (isMarkedInvalid(fields, columns, i)) {
            ++report.invalid;
            continue;
        }
        Vec3i p{values[0][i], values[1][i], values[2][i]};
        if (p.x < low[0] || p.x > high[0] || p.y < low[1] || p.y > high[1] || p.z < low[2] || p.z > high[2]) {
            ++report.outOfRange;
            continue;
        }
        kept.rows[points] = static_cast<std::uint32_t>(i);
        kept.positions[points++] = same ? p : map.toCloud(p);
    }
    kept.rows.resize(points);
    kept.positions.resize(points);
}

void locate(const ScanEntry& scan, const CoordinateFields& fields, const std::vector<Column>& columns,
            std::size_t count, Kept& kept, ReadReport& report) {
    kept.rows.resize(count);
    kept.local.resize(count);
    kept.world.resize(count);
    std::size_t points = 0;
    auto value = [&](std::size_t axis, std::size_t i) {
        return columns[fields.axes[axis]].value(scan.fields[fields.axes[axis]], i);
    };
    for (std::size_t i = 0; i < count; ++i) {
        if (isMarkedInvalid(fields, columns, i)) {
            ++report.invalid;
            continue;
        }
        Vec3d local{value(0, i), value(1, i), value(2, i)};
        if (fields.spherical) {
            double range = local.x, azimuth = local.y, elevation = local.z;
            double flat = range * std::cos(elevation);
            local = {flat * std::cos(azimuth), flat * std::sin(azimuth), range * std::sin(elevation)};
        }
        Vec3d world = scan.pose.apply(local);
        double farthest = std::max({std::abs(world.x), std::abs(world.y), std::abs(world.z)});
        if (!(std::abs(world.x + world.y + world.z) <= std::numeric_limits<double>::max())) {
            ++report.notFinite;
            continue;
        }
        if (farthest > farthestCoordinate) {
            ++report.outOfRange;
            continue;
        }
        kept.rows[points] = static_cast<std::uint32_t>(i);
        kept.local[points] = local;
        kept.world[points++] = world;
    }
    kept.rows.resize(points);
    kept.local.resize(points);
    kept.world.resize(points);
}

void roundToGrid(const Grid& grid, Kept& kept, ReadReport& report) {
    kept.positions.resize(kept.world.size());
    for (std::size_t i = 0; i < kept.world.size(); ++i) {
        Vec3d steps = grid.toSteps(kept.world[i]);
        kept.positions[i] = {nearest(steps.x), nearest(steps.y), nearest(steps.z)};
        Vec3d back = grid.toWorld(kept.positions[i]);
        for (int axis = 0; axis < 3; ++axis)
            report.maxRounding = std::max(report.maxRounding, std::abs(back[axis] - kept.world[i][axis]));
    }
}

double finestStep(const ScanEntry& scan, const CoordinateFields& fields, const BoxD& local) {
    Precision precision;
    precision.significandBits = float32Bits;
    double scale = 0; // the finest of scaled integers
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Field& field = scan.fields[fields.axes[axis]];
        if (field.kind == FieldKind::float64 || (field.isInteger() && fields.spherical))
            precision.significandBits = float64Bits;
        else if (field.isInteger() && field.scale != 0)
            scale = scale == 0 ? std::abs(field.scale) : std::min(scale, std::abs(field.scale));
    }
    double step = floatGrid(local, precision).scale.x;
    if (scale == 0)
        return step;
    // Of integers alone their own step counts; beside floats the finer of both.
    bool anyFloat = std::any_of(fields.axes.begin(), fields.axes.end(),
                                [&](std::size_t f) { return scan.fields[f].isFloat(); });
    double magnitude = 1e-300;
    for (int axis = 0; axis < 3; ++axis)
        magnitude = std::max({magnitude, std::abs(local.min[axis]), std::abs(local.max[axis])});
    // A double has 15 decimal digits: after the first of the largest coordinate, no more than these are told.
    int told = doubleDigits - static_cast<int>(std::ceil(std::log10(magnitude)));
    Precision decimal;
    decimal.decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(scale / 2))), 0, std::max(told, 0));
    double integerStep = floatGrid(local, decimal).scale.x;
    return anyFloat ? std::min(step, integerStep) : integerStep;
}

} // namespace stipple::e57
