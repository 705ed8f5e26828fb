#include "converter/input/text_guess.hpp"

#include "converter/input/text_number.hpp"

#include <algorithm>
#include <array>

namespace stipple {

namespace {
bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && isBlank(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && isBlank(text.back()))
        text.remove_suffix(1);
    return text;
}

std::vector<std::string_view> linesOf(std::string_view text) {
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
        if (std::string_view line = trimmed(text.substr(0, end)); !line.empty())
            lines.push_back(line);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

bool isPrintable(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) {
        unsigned char byte = static_cast<unsigned char>(c);
        return byte >= 32 ? byte != 127 : byte == '\t' || byte == '\n' || byte == '\r' || byte == '\f';
    });
}

bool isNumberText(std::string text, char decimalPoint) {
    text += '\n';
    Number number;
    const char* end = scanNumber(text.c_str(), decimalPoint, number);
    return end != nullptr && *end == '\n';
}

// How the values of a line are separated, and how many of its first columns are numbers.
struct Split {
    char separator = ' ';
    char decimalPoint = '.';
    std::size_t leading = 0;
    std::vector<bool> isNumber;
};

Split splitAs(std::string_view line, char separator, char decimalPoint) {
    Split split{separator, decimalPoint, 0, {}};
    std::vector<std::string> values = splitLine(line, separator);
    if (separator != ' ' && values.size() > 1 && values.back().empty())
        values.pop_back(); // a separator at the end
    for (const std::string& value : values) {
        bool number = isNumberText(value, decimalPoint) || (value.empty() && separator != ' ');
        if (number && split.leading == split.isNumber.size())
            ++split.leading;
        split.isNumber.push_back(number);
    }
    return split;
}

// The way to read a line that makes most of its first columns numbers; of equal ones the first here. A comma
// is a decimal sign only where something else separates.
Split bestSplit(std::string_view line) {
    constexpr std::array<std::array<char, 2>, 8> ways{
        {{';', '.'}, {'|', '.'}, {';', ','}, {'|', ','}, {'\t', ','}, {',', '.'}, {' ', '.'}, {' ', ','}}};
    Split best;
    for (auto [separator, decimalPoint] : ways) {
        if (separator != ' ' && line.find(separator) == std::string_view::npos)
            continue;
        if (decimalPoint == ',' && line.find(',') == std::string_view::npos)
            continue;
        Split split = splitAs(line, separator, decimalPoint);
        if (split.leading > best.leading)
            best = split;
    }
    return best;
}

std::string_view withoutMark(std::string_view line) {
    while (!line.empty() && (line.front() == '#' || line.front() == '/' || isBlank(line.front())))
        line.remove_prefix(1);
    return line;
}

// The names of a line of names: x, y and z are among them, and none is a number.
std::vector<std::string> namesOf(std::string_view line) {
    for (char separator : {',', ';', '|', '\t', ' '}) {
        std::vector<std::string> names = splitLine(withoutMark(line), separator);
        if (separator != ' ' && !names.empty() && names.back().empty())
            names.pop_back();
        std::array<bool, 3> found{};
        bool numbers = false;
        for (const std::string& name : names) {
            if (auto axis = axisOfName(name))
                found[*axis] = true;
            numbers = numbers || isNumberText(name, '.');
        }
        if (found[0] && found[1] && found[2] && !numbers)
            return names;
    }
    return {};
}
} // namespace

bool isComment(std::string_view line) {
    line = trimmed(line);
    return line.starts_with('#') || line.starts_with("//");
}

std::vector<std::string> splitLine(std::string_view line, char separator) {
    std::vector<std::string> values;
    line = trimmed(line);
    if (line.empty())
        return values;
    for (;;) {
        std::size_t end = separator == ' ' ? line.find_first_of(" \t") : line.find(separator);
        std::string_view value = trimmed(line.substr(0, end));
        if (value.size() >= 2 && value.front() == '"' && value.back() == '"')
            value = trimmed(value.substr(1, value.size() - 2));
        values.emplace_back(value);
        if (end == std::string_view::npos)
            return values;
        line.remove_prefix(end + 1);
        if (separator == ' ')
            line = trimmed(line);
    }
}

std::optional<std::size_t> axisOfName(std::string_view name) {
    std::string simple;
    for (char c : name) {
        if (c == '(' || c == '[')
            break; // a unit
        if (c != ' ' && c != '_')
            simple += c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
    }
    constexpr std::array<std::array<std::string_view, 6>, 3> known{
        {{"x", "xcoord", "easting", "east", "longitude", "lon"},
         {"y", "ycoord", "northing", "north", "latitude", "lat"},
         {"z", "zcoord", "elevation", "height", "altitude", "up"}}};
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::string_view candidate : known[axis])
            if (simple == candidate)
                return axis;
    return {};
}

const char* separatorName(char separator) {
    switch (separator) {
    case ',':
        return "commas";
    case ';':
        return "semicolons";
    case '\t':
        return "tabs";
    case '|':
        return "bars";
    default:
        return "blanks";
    }
}

std::optional<TextShape> guessTextShape(std::string_view start, bool anyHeader) {
    constexpr std::string_view byteOrderMark = "\xEF\xBB\xBF";
    const char* const begin = start.data();
    if (start.starts_with(byteOrderMark))
        start.remove_prefix(byteOrderMark.size());
    if (!isPrintable(start))
        return {};
    TextShape shape;
    auto dataBeginsAt = [&](std::string_view line) {
        shape.dataOffset = static_cast<std::uint64_t>(line.data() - begin);
        std::string_view before(begin, static_cast<std::size_t>(shape.dataOffset));
        const char ending = before.find('\n') != std::string_view::npos ? '\n' : '\r';
        shape.dataLine = 1 + static_cast<std::uint64_t>(std::count(before.begin(), before.end(), ending));
    };
    bool namesAreComment = false;
    for (std::string_view line : linesOf(start)) {
        if (isComment(line)) {
            if (std::vector<std::string> names = namesOf(line); !names.empty()) {
                shape.names = names;
                namesAreComment = true;
            }
            continue;
        }
        Split split = bestSplit(line);
        const bool isCount = line.find_first_not_of("0123456789") == std::string_view::npos;
        if (isCount && !shape.countFirst) {
            shape.countFirst = true;
            dataBeginsAt(line);
            continue;
        }
        std::size_t numbers =
            static_cast<std::size_t>(std::count(split.isNumber.begin(), split.isNumber.end(), true));
        if (split.leading >= 3 || (numbers >= 3 && (anyHeader || !shape.names.empty()))) {
            shape.separator = split.separator;
            shape.decimalPoint = split.decimalPoint;
            shape.isNumber = split.isNumber;
            if (namesAreComment && shape.names.size() != shape.isNumber.size())
                shape.names.clear(); // it only seemed to name the columns
            if (!shape.countFirst)
                dataBeginsAt(line);
            return shape;
        }
        if (anyHeader)
            continue;
        if (!shape.names.empty() || shape.countFirst)
            return {};
        shape.names = namesOf(line);
        if (shape.names.empty())
            return {};
    }
    // A header alone: a file without points.
    if (shape.names.empty() || shape.countFirst)
        return {};
    shape.isNumber.assign(shape.names.size(), true);
    dataBeginsAt(start.substr(start.size()));
    return shape;
}

} // namespace stipple
