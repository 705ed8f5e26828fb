// Rows of numbers in lines of text: the bodies of text files, PTX, and PLY and PCD in ASCII.
#pragma once

#include "converter/input/table.hpp"
#include "converter/input/text_lines.hpp"

namespace stipple {

// One column of a line.
struct TextColumn {
    enum class Kind : std::uint8_t {
        number, // goes to component `component` of field `field`
        skip,   // any text
        list    // a count, then so many values, all skipped (PLY)
    };
    Kind kind = Kind::number;
    std::size_t field = 0, component = 0;
};

// What lines look like.
struct LineFormat {
    char separator = ' '; // ' ': any run of blanks and tabs; else one such byte, with blanks around
    char decimalPoint = '.';
    std::vector<TextColumn> columns;
};

// Reads the numbers of the line at `lines.at()` into row `row` of `rows` and passes the line. Errors name the
// line and the column: too few or too many columns, no number, an integer that its declared type can't hold.
// An empty value between separators is "no number" (NaN), also for a column of integers whose type is open.
Status readRow(TextLines& lines, const LineFormat& format, const std::vector<TableField>& fields, Rows& rows,
               std::size_t row);

// First byte of the line that is no blank; '\n' where there is none.
char firstByte(const TextLines& lines);
// Passes the line whatever it holds.
void passLine(TextLines& lines);
// The line without its end.
std::string_view lineText(const TextLines& lines);

// Rows that follow each other without anything between but empty lines; borrows all but `place`. Ends after
// row `rowCount`: a file that ends before is `truncated`.
std::unique_ptr<RowReader> readTextRows(SharedSource& source, const LineFormat& format,
                                        const std::vector<TableField>& fields, std::uint64_t rowCount,
                                        const RowPlace& place);

} // namespace stipple
