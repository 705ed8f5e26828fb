// What a text file of points looks like, told by its first lines: separator, decimal sign, names of columns.
#pragma once

#include "converter/input/text_lines.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace stipple {

struct TextShape {
    char separator = ' '; // ' ': blanks and tabs
    char decimalPoint = '.';
    std::vector<std::string> names; // of the header line; empty: there is none
    std::vector<bool> isNumber;     // of each column of the first line of data
    bool countFirst = false;        // PTS: a number of points stands above the data
    std::uint64_t dataOffset = 0;   // byte of the first line of data, or of the count above it
    std::uint64_t dataLine = 1;
};

// Looks at the lines that begin the file, which stand whole in `start` (comments, header and at least one
// line of data, if the file has one). Nothing where they are no text, or no line begins with three numbers or
// a header of columns. `anyHeader`: lines that say nothing are passed over on the way to the data.
std::optional<TextShape> guessTextShape(std::string_view start, bool anyHeader = false);

// Values of a line, without blanks and quotes around.
std::vector<std::string> splitLine(std::string_view line, char separator);

// "#…" or "//…".
bool isComment(std::string_view line);

// 0, 1, 2 for a name of the axis x, y, z ("X", "easting", "Z[m]", …); nothing for others.
std::optional<std::size_t> axisOfName(std::string_view name);

// "blanks", "commas", …
const char* separatorName(char separator);

} // namespace stipple
