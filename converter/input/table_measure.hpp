// What the columns of a table hold, found by looking at every row; and which rows are points.
#pragma once

#include "converter/input/table.hpp"
#include "shared/geometry/box.hpp"

namespace stipple {

// The values of one column of one component. Of rows that are no points nothing counts.
struct FieldRange {
    bool any = false;
    bool whole = true;       // each is an integer that 64 bits hold
    bool fractional = false; // one was written with a point or an exponent (text)
    bool allFinite = true;
    double min = 0, max = 0; // of the finite ones
    std::int64_t minWhole = 0;
    std::uint64_t maxWhole = 0; // meaningful where `whole`

    void add(const FieldRange& other);
    bool isWithin(double low, double high) const { return !any || (allFinite && min >= low && max <= high); }
    bool isWholeWithin(double low, double high) const { return whole && isWithin(low, high); }
};

// The extremes of one axis of text, exactly: integers of 10^-decimals.
struct DecimalRange {
    int decimals = 0; // most that a coordinate has, without zeros at the end; at most mostDecimals
    __int128 min = 0, max = 0;
    bool any = false, cut = false; // cut: some had more decimals

    static constexpr int mostDecimals = 24;
    void add(const Number& number);
    void add(DecimalRange other);
    void addDecimals(int count);
};

struct Measure {
    std::vector<FieldRange> fields;          // parallel to Table::fields; only those of one component
    std::array<DecimalRange, 3> decimalAxes; // of coordinates of text
    BoxD bounds;                             // of the points
    std::uint64_t points = 0;

    void add(const Measure& other); // of other rows of the same table
};

// Takes away the rows that are no points: marked invalid, or a coordinate that is not finite or out of range
// (float_grid.hpp), counting them. Rows before are the file's, rows after have lost `invalid`.
void keepPoints(const Table& table, Rows& rows, ReadReport& report);

// Adds rows that are points.
void measureRows(const Table& table, const Rows& rows, Measure& measure);

} // namespace stipple
