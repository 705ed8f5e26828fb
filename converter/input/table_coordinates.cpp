#include "converter/input/table_coordinates.hpp"

#include "converter/input/table_values.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>

namespace stipple {

namespace {
constexpr int mostPower = 36; // 10^36 × 2^6 < 2^127

__int128 powerOfTen128(int exponent) {
    __int128 power = 1;
    for (; exponent > 18; exponent -= 18)
        power *= powerOfTen64(18);
    return power * powerOfTen64(exponent);
}

// The decimals of a power of ten.
std::optional<int> decimalsOf(double step) {
    constexpr int fewest = -12, most = DecimalRange::mostDecimals;
    for (int decimals = fewest; decimals <= most; ++decimals) {
        std::array<char, 8> text{'1', 'e'};
        std::to_chars(text.data() + 2, text.data() + text.size(), -decimals);
        if (std::strtod(text.data(), nullptr) == step)
            return decimals;
    }
    return {};
}

Number shortestNumber(double value) {
    std::array<char, 40> text{};
    char* end = std::to_chars(text.data(), text.data() + text.size() - 1, value).ptr;
    *end = '\n';
    Number number;
    scanNumber(text.data(), '.', number);
    return number;
}

// mantissa × 10^shift, rounded to the nearest integer; `error` is how far that is from it.
__int128 shifted(__int128 mantissa, int shift, double& error) {
    error = 0;
    if (mantissa == 0)
        return 0;
    if (shift >= 0)
        return mantissa * powerOfTen128(std::min(shift, mostPower)); // within the range by largestCoordinate
    if (-shift > mostPower) {
        error = static_cast<double>(mantissa) * std::pow(10.0, shift);
        return 0;
    }
    __int128 power = powerOfTen128(-shift);
    __int128 quotient = mantissa / power, rest = mantissa % power;
    if (rest != 0) {
        error = static_cast<double>(rest < 0 ? -rest : rest) / static_cast<double>(power);
        if (error >= 0.5) {
            quotient += mantissa < 0 ? -1 : 1;
            error = 1 - error;
        }
    }
    return quotient;
}
} // namespace

CoordinateScale::CoordinateScale(const Grid& grid) : grid_(grid) {
    std::optional<int> decimals = decimalsOf(grid.scale.x);
    if (!decimals || grid.scale.y != grid.scale.x || grid.scale.z != grid.scale.x)
        return;
    decimals_ = *decimals;
    decimal_ = true;
    for (int axis = 0; axis < 3; ++axis) {
        Number offset = shortestNumber(grid.offset[axis]);
        double error = 0;
        offset_[static_cast<std::size_t>(axis)] =
            shifted(offset.mantissa, decimals_ + offset.exponent, error);
        decimal_ = decimal_ && error == 0;
    }
}

std::int64_t CoordinateScale::toGrid(int axis, double coordinate, double& maxRounding) const {
    constexpr double unseen = 2.3e-16; // of a coordinate: what a double can't tell
    double scale = grid_.scale[axis], offset = grid_.offset[axis];
    double steps = (coordinate - offset) / scale;
    constexpr double limit = 9e18;
    std::int64_t rounded = std::llround(std::clamp(steps, -limit, limit));
    double error = std::abs(offset + scale * static_cast<double>(rounded) - coordinate);
    if (error > maxRounding && error > unseen * std::abs(coordinate))
        maxRounding = error;
    return rounded;
}

std::int64_t CoordinateScale::toGrid(int axis, const Number& coordinate, double& maxRounding) const {
    if (!decimal_)
        return toGrid(axis, toDouble(coordinate), maxRounding);
    std::size_t a = static_cast<std::size_t>(axis);
    int shift = decimals_ + coordinate.exponent;
    std::int64_t product;
    if (shift >= 0 && shift <= 18 &&
        !__builtin_mul_overflow(coordinate.mantissa, powerOfTen64(shift), &product) && !coordinate.cut)
        return static_cast<std::int64_t>(product - offset_[a]);
    // As DecimalRange: what is behind the decimals that count is cut before rounding, so bounds stay bounds.
    std::int64_t mantissa = coordinate.mantissa;
    if (int extra = -DecimalRange::mostDecimals - coordinate.exponent; extra > 0) {
        mantissa = extra > 18 ? 0 : mantissa / powerOfTen64(extra);
        shift += extra;
    }
    double error = 0;
    std::int64_t rounded = static_cast<std::int64_t>(shifted(mantissa, shift, error) - offset_[a]);
    if (coordinate.cut && error == 0)
        error = std::pow(10.0, shift);
    maxRounding = std::max(maxRounding, error * grid_.scale[axis]);
    return rounded;
}

std::int64_t CoordinateScale::toGrid(int axis, __int128 value, int decimals) const {
    if (!decimal_) {
        double unused = 0;
        return toGrid(axis, decimalToDouble(value, decimals), unused);
    }
    double unused = 0;
    return static_cast<std::int64_t>(shifted(value, decimals_ - decimals, unused) -
                                     offset_[static_cast<std::size_t>(axis)]);
}

double decimalToDouble(__int128 value, int decimals) {
    std::array<char, 64> text;
    char* at = text.data() + 48;
    char* end = std::to_chars(at + 1, text.data() + text.size(), -decimals).ptr;
    *at = 'e';
    bool negative = value < 0;
    do {
        int digit = static_cast<int>(value % 10);
        *--at = static_cast<char>('0' + (digit < 0 ? -digit : digit));
        value /= 10;
    } while (value != 0);
    if (negative)
        *--at = '-';
    double result = 0;
    std::from_chars(at, end, result);
    return result;
}

void convertPositions(const Table& table, const CoordinateScale& scale, const Rows& rows, Vec3i* positions,
                      double& maxRounding) {
    for (int axis = 0; axis < 3; ++axis) {
        std::size_t field = table.position[static_cast<std::size_t>(axis)];
        const std::uint8_t* column = rows.columns[field].data();
        visitRows(table.fields[field], [&](auto zero) {
            using T = decltype(zero);
            for (std::size_t i = 0; i < rows.count; ++i) {
                T value = loadLe<T>(column + i * sizeof(T));
                if constexpr (std::is_same_v<T, Number>)
                    positions[i][axis] = scale.toGrid(axis, value, maxRounding);
                else
                    positions[i][axis] = scale.toGrid(axis, static_cast<double>(value), maxRounding);
            }
        });
    }
}

} // namespace stipple
