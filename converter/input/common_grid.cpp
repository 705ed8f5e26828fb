#include "converter/input/common_grid.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

namespace stipple {

namespace {
using Int128 = __int128;

constexpr Int128 int128Limit = static_cast<Int128>(1) << 125;
constexpr std::int64_t finestStepRatio = 1000;
constexpr double mostSteps = 4503599627370496.0; // 2^52: the widest root cube

// mantissa × 10^exponent
struct Decimal {
    Int128 mantissa = 0;
    int exponent = 0;
};

Decimal shortestDecimal(double value) {
    char text[48];
    auto written = std::to_chars(text, text + sizeof text, value, std::chars_format::scientific);
    Decimal decimal;
    bool negative = false, fraction = false;
    const char* at = text;
    for (; at != written.ptr && *at != 'e'; ++at) {
        if (*at == '-') {
            negative = true;
        } else if (*at == '.') {
            fraction = true;
        } else {
            decimal.mantissa = decimal.mantissa * 10 + (*at - '0');
            decimal.exponent -= fraction ? 1 : 0;
        }
    }
    int exponent = 0;
    if (at != written.ptr) {
        ++at; // 'e'
        if (at != written.ptr && *at == '+')
            ++at;
        std::from_chars(at, written.ptr, exponent);
    }
    decimal.exponent += exponent;
    if (negative)
        decimal.mantissa = -decimal.mantissa;
    return decimal;
}

// The mantissas of `values` over one common exponent; nothing if they span too many digits.
struct CommonDecimals {
    std::vector<Int128> mantissas;
    int exponent = 0;
};
std::optional<CommonDecimals> toCommonExponent(const std::vector<double>& values) {
    std::vector<Decimal> decimals;
    CommonDecimals common;
    common.exponent = std::numeric_limits<int>::max();
    for (double value : values) {
        decimals.push_back(shortestDecimal(value));
        if (decimals.back().mantissa != 0)
            common.exponent = std::min(common.exponent, decimals.back().exponent);
    }
    for (Decimal decimal : decimals) {
        while (decimal.mantissa != 0 && decimal.exponent > common.exponent) {
            decimal.mantissa *= 10;
            --decimal.exponent;
            if (decimal.mantissa > int128Limit / 16 || decimal.mantissa < -int128Limit / 16)
                return std::nullopt;
        }
        common.mantissas.push_back(decimal.mantissa);
    }
    return common;
}

Int128 absolute(Int128 value) {
    return value < 0 ? -value : value;
}
Int128 greatestCommonDivisor(Int128 a, Int128 b) {
    while (b != 0) {
        Int128 rest = a % b;
        a = b;
        b = rest;
    }
    return absolute(a);
}

double toDouble(Int128 mantissa, int exponent) {
    std::string digits;
    for (Int128 rest = mantissa; rest > 0; rest /= 10)
        digits.push_back(static_cast<char>('0' + static_cast<int>(rest % 10)));
    std::reverse(digits.begin(), digits.end());
    digits += 'e';
    digits += std::to_string(exponent);
    double value = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return value;
}

// The exact common step of scales and offsets on one axis; nothing if it is too fine to be of use.
std::optional<double> commonStep(const std::vector<double>& scales, const std::vector<double>& offsets) {
    std::vector<double> values = scales;
    values.insert(values.end(), offsets.begin(), offsets.end());
    auto common = toCommonExponent(values);
    if (!common)
        return std::nullopt;
    Int128 step = 0, finest = common->mantissas[0];
    for (std::size_t i = 0; i < scales.size(); ++i) {
        step = greatestCommonDivisor(step, common->mantissas[i]);
        finest = std::min(finest, common->mantissas[i]);
    }
    for (std::size_t i = scales.size(); i < values.size(); ++i)
        step = greatestCommonDivisor(step, common->mantissas[i] - common->mantissas[scales.size()]);
    if (finest / step > finestStepRatio)
        return std::nullopt;
    return toDouble(step, common->exponent);
}

double tenTimes(double step) {
    Decimal decimal = shortestDecimal(step);
    return toDouble(decimal.mantissa, decimal.exponent + 1);
}

// How far the boxes reach on an axis, seen from the common offset; 0 without boxes.
double extentFrom(double offset, int axis, const std::vector<Grid>& grids, const std::vector<BoxI>& boxes) {
    double low = offset, high = offset;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (boxes[i].empty())
            continue;
        low = std::min(low, grids[i].toWorld(boxes[i].min)[axis]);
        high = std::max(high, grids[i].toWorld(boxes[i].max)[axis]);
    }
    return high - low;
}

// 0 and -0 are one offset, but not the same bytes in a file: without this the first input would choose.
Grid withoutNegativeZero(Grid grid) {
    for (int axis = 0; axis < 3; ++axis)
        grid.offset[axis] += 0.0;
    return grid;
}

AxisMap axisMap(double fromScale, double fromOffset, double toScale, double toOffset) {
    AxisMap map;
    if (fromScale == toScale && fromOffset == toOffset)
        return map;
    auto common = toCommonExponent({fromScale, fromOffset, toScale, toOffset});
    constexpr Int128 multiplyLimit = static_cast<Int128>(1) << 30, addLimit = static_cast<Int128>(1) << 61;
    if (common) {
        const std::vector<Int128>& m = common->mantissas;
        Int128 distance = m[1] - m[3];
        if (m[0] % m[2] == 0 && distance % m[2] == 0 && m[0] / m[2] < multiplyLimit &&
            absolute(distance / m[2]) < addLimit) {
            map.multiply = static_cast<std::int64_t>(m[0] / m[2]);
            map.add = static_cast<std::int64_t>(distance / m[2]);
            return map;
        }
    }
    map.exact = false;
    map.factor = fromScale / toScale;
    map.shift = (fromOffset - toOffset) / toScale;
    return map;
}
} // namespace

std::int64_t AxisMap::toCloud(std::int64_t input) const {
    // Far outside what a root cube can hold; kept defined, and refused when the cube is laid.
    constexpr std::int64_t limit = 4'000'000'000'000'000'000;
    if (exact) {
        std::int64_t product = 0, sum = 0;
        if (__builtin_mul_overflow(multiply, input, &product) || __builtin_add_overflow(product, add, &sum))
            return (input < 0) == (multiply > 0) ? -limit : limit;
        return sum;
    }
    double steps = std::round(factor * static_cast<double>(input) + shift);
    return static_cast<std::int64_t>(
        std::clamp(steps, -static_cast<double>(limit), static_cast<double>(limit)));
}

double AxisMap::errorSteps(std::int64_t input) const {
    if (exact)
        return 0;
    return std::abs(factor * static_cast<double>(input) + shift - static_cast<double>(toCloud(input)));
}

Grid commonGrid(const std::vector<Grid>& grids, const std::vector<BoxI>& boxes) {
    bool same = std::all_of(grids.begin(), grids.end(), [&](const Grid& grid) { return grid == grids[0]; });
    if (same)
        return withoutNegativeZero(grids[0]);
    Grid result;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> scales, offsets;
        for (const Grid& grid : grids) {
            scales.push_back(grid.scale[axis]);
            offsets.push_back(grid.offset[axis]);
        }
        double finest = *std::min_element(scales.begin(), scales.end());
        result.offset[axis] = *std::min_element(offsets.begin(), offsets.end());
        result.scale[axis] = commonStep(scales, offsets).value_or(finest);
        double extent = extentFrom(result.offset[axis], axis, grids, boxes);
        if (extent / result.scale[axis] >= mostSteps)
            result.scale[axis] = finest;
        while (extent / result.scale[axis] >= mostSteps)
            result.scale[axis] = tenTimes(result.scale[axis]);
    }
    return withoutNegativeZero(result);
}

GridMap gridMap(const Grid& from, const Grid& to) {
    GridMap map;
    for (int axis = 0; axis < 3; ++axis)
        map.axes[static_cast<std::size_t>(axis)] =
            axisMap(from.scale[axis], from.offset[axis], to.scale[axis], to.offset[axis]);
    return map;
}

} // namespace stipple
