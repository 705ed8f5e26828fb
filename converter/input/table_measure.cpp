#include "converter/input/table_measure.hpp"

#include "converter/input/float_grid.hpp"
#include "converter/input/table_values.hpp"

#include <algorithm>

namespace stipple {

namespace {
enum Reason : std::uint8_t { isPoint = 0, isInvalid = 1, isNotFinite = 2, isOutOfRange = 3 };

Reason reasonOf(double value) {
    if (std::abs(value) <= largestCoordinate)
        return isPoint;
    return std::isfinite(value) ? isOutOfRange : isNotFinite;
}
Reason reasonOf(const Number& number) {
    constexpr auto surely = static_cast<std::int64_t>(largestCoordinate);
    if (number.isFinite() && number.exponent <= 0 && number.mantissa <= surely && number.mantissa >= -surely)
        return isPoint;
    return reasonOf(toDouble(number));
}

void findReasons(const TableField& field, const Rows& rows, const Bytes& column,
                 std::vector<std::uint8_t>& reasons) {
    visitRows(field, [&](auto zero) {
        using T = decltype(zero);
        for (std::size_t i = 0; i < rows.count; ++i) {
            T value = loadLe<T>(column.data() + i * sizeof(T));
            Reason reason;
            if constexpr (std::is_same_v<T, Number>)
                reason = reasonOf(value);
            else
                reason = reasonOf(static_cast<double>(value));
            if (reason != isPoint && (reasons[i] == isPoint || reasons[i] == isOutOfRange))
                reasons[i] = reason;
        }
    });
}

// Keeps the rows that are points, in order.
void compact(const std::vector<std::uint8_t>& reasons, std::size_t width, Bytes& column) {
    std::size_t to = 0;
    for (std::size_t i = 0; i < reasons.size(); ++i)
        if (reasons[i] == isPoint) {
            std::memmove(column.data() + to, column.data() + i * width, width);
            to += width;
        }
    column.resize(to);
}

void addWhole(FieldRange& range, std::int64_t low, std::uint64_t high) {
    range.minWhole = std::min(range.minWhole, low);
    range.maxWhole = std::max(range.maxWhole, high);
}

void addDouble(FieldRange& range, double value) {
    if (!std::isfinite(value)) {
        range.allFinite = range.whole = false;
        return;
    }
    range.min = range.any ? std::min(range.min, value) : value;
    range.max = range.any ? std::max(range.max, value) : value;
    range.any = true;
}

void addValue(FieldRange& range, const Number& number) {
    range.fractional = range.fractional || number.fractional;
    WholeNumber whole = number.exponent == 0 && number.isFinite() && !number.cut
                            ? WholeNumber{true, number.mantissa}
                            : toWhole(number);
    if (whole.fits) {
        addWhole(range, whole.value, static_cast<std::uint64_t>(std::max<std::int64_t>(whole.value, 0)));
        addDouble(range, static_cast<double>(whole.value));
    } else {
        range.whole = false;
        addDouble(range, toDouble(number));
    }
}
template <class T>
void addValue(FieldRange& range, T value) {
    if constexpr (std::is_integral_v<T>) {
        if constexpr (std::is_signed_v<T>)
            addWhole(range, value, static_cast<std::uint64_t>(std::max<T>(value, 0)));
        else
            addWhole(range, 0, value);
        addDouble(range, static_cast<double>(value));
    } else {
        constexpr double wholeLimit = 9007199254740992.0; // 2^53
        double number = static_cast<double>(value);
        if (range.whole && std::abs(number) <= wholeLimit && number == std::trunc(number))
            addWhole(range, static_cast<std::int64_t>(number),
                     static_cast<std::uint64_t>(std::max(number, 0.0)));
        else
            range.whole = false;
        addDouble(range, number);
    }
}

void measureField(const TableField& field, const Rows& rows, const Bytes& column, FieldRange& range) {
    visitRows(field, [&](auto zero) {
        using T = decltype(zero);
        FieldRange sum = range;
        for (std::size_t i = 0; i < rows.count; ++i)
            addValue(sum, loadLe<T>(column.data() + i * sizeof(T)));
        range = sum;
    });
}

__int128 powerOfTen128(int exponent) {
    __int128 power = 1;
    for (; exponent > 18; exponent -= 18)
        power *= powerOfTen64(18);
    return power * powerOfTen64(exponent);
}
} // namespace

void DecimalRange::addDecimals(int count) {
    count = std::min(count, mostDecimals);
    if (count <= decimals)
        return;
    __int128 factor = powerOfTen128(count - decimals);
    min *= factor;
    max *= factor;
    decimals = count;
}

void FieldRange::add(const FieldRange& other) {
    whole = whole && other.whole;
    fractional = fractional || other.fractional;
    allFinite = allFinite && other.allFinite;
    addWhole(*this, other.minWhole, other.maxWhole);
    if (!other.any)
        return;
    min = any ? std::min(min, other.min) : other.min;
    max = any ? std::max(max, other.max) : other.max;
    any = true;
}

void DecimalRange::add(DecimalRange other) {
    cut = cut || other.cut;
    if (!other.any)
        return;
    addDecimals(other.decimals);
    other.addDecimals(decimals);
    min = any ? std::min(min, other.min) : other.min;
    max = any ? std::max(max, other.max) : other.max;
    any = true;
}

void Measure::add(const Measure& other) {
    fields.resize(std::max(fields.size(), other.fields.size()));
    for (std::size_t f = 0; f < other.fields.size(); ++f)
        fields[f].add(other.fields[f]);
    for (std::size_t axis = 0; axis < 3; ++axis)
        decimalAxes[axis].add(other.decimalAxes[axis]);
    bounds.extend(other.bounds);
    points += other.points;
}

void DecimalRange::add(const Number& number) {
    std::int64_t mantissa = number.mantissa;
    int exponent = number.exponent;
    if (mantissa == 0)
        exponent = 0;
    if (-exponent > decimals) {
        while (-exponent > decimals && mantissa % 10 == 0) {
            mantissa /= 10;
            ++exponent;
        }
        addDecimals(-exponent);
    }
    cut = cut || number.cut || -exponent > mostDecimals;
    __int128 value = mantissa;
    if (int shift = decimals + exponent; shift > 0)
        value *= powerOfTen128(shift);
    else
        for (; shift < 0 && value != 0; ++shift)
            value /= 10;
    min = any ? std::min(min, value) : value;
    max = any ? std::max(max, value) : value;
    any = true;
}

void keepPoints(const Table& table, Rows& rows, ReadReport& report) {
    std::vector<std::uint8_t> reasons(rows.count, isPoint);
    for (std::size_t i = 0; i < rows.invalid.size(); ++i)
        reasons[i] = rows.invalid[i] != 0 ? isInvalid : isPoint;
    for (std::size_t field : table.position)
        findReasons(table.fields[field], rows, rows.columns[field], reasons);
    rows.invalid.clear();
    std::array<std::size_t, 4> counts{};
    for (std::uint8_t reason : reasons)
        ++counts[reason];
    if (counts[isPoint] == rows.count)
        return;
    report.invalid += counts[isInvalid];
    report.notFinite += counts[isNotFinite];
    report.outOfRange += counts[isOutOfRange];
    for (std::size_t f = 0; f < table.fields.size(); ++f)
        compact(reasons, table.fields[f].bytesPerRow(), rows.columns[f]);
    rows.count = counts[isPoint];
}

void measureRows(const Table& table, const Rows& rows, Measure& measure) {
    measure.fields.resize(table.fields.size());
    measure.points += rows.count;
    for (std::size_t f = 0; f < table.fields.size(); ++f) {
        const TableField& field = table.fields[f];
        if (field.components == 1 &&
            std::find(table.position.begin(), table.position.end(), f) == table.position.end())
            measureField(field, rows, rows.columns[f], measure.fields[f]);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const TableField& field = table.fields[table.position[axis]];
        const Bytes& column = rows.columns[table.position[axis]];
        if (field.isText) {
            DecimalRange sum = measure.decimalAxes[axis];
            for (std::size_t i = 0; i < rows.count; ++i)
                sum.add(loadLe<Number>(column.data() + i * sizeof(Number)));
            measure.decimalAxes[axis] = sum;
            continue;
        }
        double& low = measure.bounds.min[static_cast<int>(axis)];
        double& high = measure.bounds.max[static_cast<int>(axis)];
        visitType(*field.type, [&](auto zero) {
            using T = decltype(zero);
            double min = low, max = high;
            for (std::size_t i = 0; i < rows.count; ++i) {
                double value = static_cast<double>(loadLe<T>(column.data() + i * sizeof(T)));
                min = std::min(min, value);
                max = std::max(max, value);
            }
            low = min;
            high = max;
        });
    }
}

} // namespace stipple
