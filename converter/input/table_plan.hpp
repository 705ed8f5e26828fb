// What the columns of a table become: attributes with the names and types of LAS where the meaning is that of
// LAS and every value fits, else attributes with the file's own names and types.
//
//   red, diffuse_red, r …     Red …       u16. Integers of 0 to 65535 as they are, so 8-bit colours stay 0 to
//   255.
//                                          Numbers of 0 to 1 that are no integer type: round(65535 × value).
//                                          All three colours alike, or all three under their own names.
//   intensity                 Intensity   u16. Integers of 0 to 65535 as they are; numbers of 0 to 1: as
//   colours.
//                                          PTS: value + 2048.
//   classification …          as in LAS   integers within the type of LAS (tables 7 to 18) as they are
//   rgb, rgba of PCD          Red …       bytes 2, 1, 0 of the packed word; byte 3 of rgba: "alpha", u8
//   any other                 its name    its type; of text: the smallest integer type that holds every
//   value, or
//                                          f64
#pragma once

#include "converter/input/table_measure.hpp"
#include "shared/points/point_batch.hpp"

namespace stipple {

struct FieldStep {
    enum class How : std::uint8_t {
        copy,    // the same bytes
        value,   // the same number in another type
        unit,    // round(65535 × number)
        shifted, // number + 2048
        byte     // byte `index` of the word
    };
    std::size_t field = 0, attribute = 0;
    How how = How::copy;
    int index = 0;
};

struct TablePlan {
    Schema schema;
    std::vector<FieldStep> steps; // in any order; together they fill every attribute
    std::vector<std::string> warnings;
};

TablePlan planTable(const Table& table, const std::vector<FieldRange>& ranges);

// Writes the attributes of `rows` (points only) to rows `at`… of `batch`, which has the plan's schema.
void convertColumns(const Table& table, const TablePlan& plan, const Rows& rows, PointBatch& batch,
                    std::size_t at);

} // namespace stipple
