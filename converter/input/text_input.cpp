#include "converter/input/text_input.hpp"

#include "converter/input/table_measure.hpp"
#include "converter/input/text_guess.hpp"
#include "converter/input/text_rows.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <atomic>

namespace stipple {

namespace {
constexpr std::uint64_t stretchBytes = std::uint64_t{1} << 22; // read by one thread without asking
constexpr std::size_t startBytes = std::size_t{1} << 16, mostColumns = 1000;

// The whole lines of the beginning of a file.
std::string_view wholeLines(std::string_view start, bool isWholeFile) {
    if (isWholeFile)
        return start;
    std::size_t end = start.find_last_of("\r\n");
    return start.substr(0, end == std::string_view::npos ? 0 : end + 1);
}

std::string unquoted(std::string_view name) {
    while (!name.empty() && (name.front() == '"' || name.front() == ' '))
        name.remove_prefix(1);
    while (!name.empty() && (name.back() == '"' || name.back() == ' '))
        name.remove_suffix(1);
    return std::string(name);
}

// What the columns of a file without a header are, told by their number and values. Empty: not known.
std::vector<std::string> guessNames(const std::vector<FieldRange>& ranges) {
    auto areColours = [&](std::size_t first) {
        return std::all_of(ranges.begin() + static_cast<std::ptrdiff_t>(first),
                           ranges.begin() + static_cast<std::ptrdiff_t>(first + 3),
                           [](const FieldRange& range) { return range.isWholeWithin(0, 65535); });
    };
    auto areNormals = [&](std::size_t first) {
        return std::all_of(ranges.begin() + static_cast<std::ptrdiff_t>(first),
                           ranges.begin() + static_cast<std::ptrdiff_t>(first + 3),
                           [](const FieldRange& range) { return range.isWithin(-1, 1); });
    };
    const std::vector<std::string> xyz{"x", "y", "z"}, rgb{"red", "green", "blue"}, n{"nx", "ny", "nz"};
    auto joined = [&](std::initializer_list<std::vector<std::string>> parts) {
        std::vector<std::string> names;
        for (const std::vector<std::string>& part : parts)
            names.insert(names.end(), part.begin(), part.end());
        return names;
    };
    switch (ranges.size()) {
    case 3:
        return xyz;
    case 4:
        return joined({xyz, {"intensity"}});
    case 6:
        return areColours(3) ? joined({xyz, rgb}) : areNormals(3) ? joined({xyz, n}) : joined({});
    case 7:
        return areColours(4)   ? joined({xyz, {"intensity"}, rgb})
               : areColours(3) ? joined({xyz, rgb, {"intensity"}})
               : areNormals(4) ? joined({xyz, {"intensity"}, n})
                               : joined({});
    case 9:
        return areColours(3) && areNormals(6) ? joined({xyz, rgb, n}) : joined({});
    case 10:
        return areColours(4) && areNormals(7) ? joined({xyz, {"intensity"}, rgb, n}) : joined({});
    default:
        return {};
    }
}

// What a file turned out to hold; set by any reader.
struct Findings {
    std::atomic<bool> moreThanCounted{false};
};

class TextReader final : public RowReader {
  public:
    TextReader(SharedSource& source, const LineFormat& format, const std::vector<TableField>& fields,
               bool counts, Findings& findings, const RowPlace& place)
        : lines_(source, place.offset, place.line), format_(format), fields_(fields), counts_(counts),
          findings_(findings), place_(place) {}

    Status next(Rows& rows, std::size_t most) override {
        rows.resize(fields_, most);
        std::size_t filled = 0;
        bool atEndOfFile = false;
        while (filled < most) {
            STIPPLE_TRY(more, lines_.load());
            if (!more || lines_.offset() >= place_.end) {
                atEndOfFile = !more;
                break;
            }
            const char first = firstByte(lines_);
            if (first == '\n' || first == '#' || (first == '/' && isComment(lineText(lines_)))) {
                passLine(lines_);
                continue;
            }
            if (counts_ && place_.rowInSection >= place_.section && readCount())
                continue;
            STIPPLE_CHECK(readRow(lines_, format_, fields_, rows, filled));
            ++place_.row;
            ++place_.rowInSection;
            ++filled;
        }
        if (filled < most)
            rows.resize(fields_, filled);
        if (counts_ && filled == 0 && atEndOfFile && place_.rowInSection < place_.section)
            return Error{
                ErrorCode::truncated,
                cat("the file promises ", place_.section, " points, but holds ", place_.rowInSection),
                lines_.place(), "complete it, or take the line with their number out"};
        return {};
    }
    RowPlace place() const override {
        RowPlace place = place_;
        place.offset = lines_.offset();
        place.line = lines_.line();
        return place;
    }

  private:
    // A line with the number of points that follow begins a section.
    bool readCount() {
        Number number;
        const char* at = lines_.at();
        while (*at == ' ' || *at == '\t')
            ++at;
        const char* end = scanNumber(at, format_.decimalPoint, number);
        while (end != nullptr && (*end == ' ' || *end == '\t' || *end == '\r'))
            ++end;
        WholeNumber count = toWhole(number);
        if (end == nullptr || *end != '\n' || !count.fits || count.value < 0) {
            if (place_.row > 0)
                findings_.moreThanCounted = true;
            return false;
        }
        place_.section = static_cast<std::uint64_t>(count.value);
        place_.rowInSection = 0;
        passLine(lines_);
        return true;
    }

    TextLines lines_;
    const LineFormat& format_;
    const std::vector<TableField>& fields_;
    bool counts_; // sections of counted points, as in PTS: `section` is the count
    Findings& findings_;
    RowPlace place_;
};

class TextFormat final : public TableFormat {
  public:
    explicit TextFormat(std::unique_ptr<SharedSource> source) : owned_(std::move(source)), source_(*owned_) {}

    Status open(const InputOptions& options) {
        STIPPLE_TRY(bytes, source_.read({0, startBytes}));
        std::string_view start(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        start = wholeLines(start, bytes.size() == source_.sizeBytes());
        std::optional<TextShape> shape = guessTextShape(start, !options.columns.empty());
        if (!shape)
            return Error{ErrorCode::unsupported, "its first lines are no points: no line has three numbers",
                         source_.name(), "are there lines of x, y and z, and a header of at most one line?"};
        shape_ = *shape;
        begin_.offset = shape_.dataOffset;
        begin_.line = shape_.dataLine;
        lineFormat_.separator = shape_.separator;
        lineFormat_.decimalPoint = shape_.decimalPoint;
        return nameColumns(options.columns);
    }

    const Table& table() const override { return table_; }
    RowPlace begin() const override { return begin_; }
    SharedSource& source() const override { return source_; }
    Result<std::unique_ptr<RowReader>> rowsFrom(const RowPlace& place) const override {
        // Behind the first stretch there are rows alone, unless they are read again (areWhole).
        const bool counts = shape_.countFirst && !isLaterStretch(place);
        return std::unique_ptr<RowReader>(
            std::make_unique<TextReader>(source_, lineFormat_, table_.fields, counts, findings_, place));
    }

    // Of some megabytes each, between two lines.
    RowStretches stretches() const override {
        RowStretches result{{begin_}};
        for (std::uint64_t at = begin_.offset + stretchBytes; at + stretchBytes / 2 < source_.sizeBytes();
             at += stretchBytes) {
            std::optional<std::uint64_t> line = lineBehind(at);
            if (!line)
                return {{begin_}};
            result.places.back().end = *line;
            RowPlace next;
            next.offset = *line;
            next.section = laterStretch;
            result.places.push_back(next);
        }
        return result;
    }
    // One section of points, as many as the line above the first says: what begins another is a line in
    // their midst, which only who has counted the rows before it knows.
    bool areWhole(const RowPlace& endOfFirst, std::uint64_t rows) const override {
        return !shape_.countFirst ||
               (endOfFirst.rowInSection == endOfFirst.row && endOfFirst.section == rows);
    }

    void finish(const std::vector<FieldRange>& ranges) override {
        if (!areNamed_ && table_.fields.size() == lineFormat_.columns.size())
            guessFrom(ranges);
        std::string list;
        for (const TextColumn& column : lineFormat_.columns)
            list += cat(list.empty() ? "" : " ",
                        column.kind == TextColumn::Kind::skip ? "-" : table_.fields[column.field].name);
        table_.format = cat(shape_.countFirst ? "PTS" : "text", ", columns separated by ",
                            separatorName(shape_.separator),
                            shape_.decimalPoint == ',' ? " with decimal commas" : "", ": ", list);
        if (!areNamed_)
            table_.warnings.insert(table_.warnings.begin(),
                                   cat("no header names the columns; taken as ", list, ", separated by ",
                                       separatorName(shape_.separator), " (--columns names them otherwise)"));
        if (findings_.moreThanCounted)
            table_.warnings.push_back("there are more points than the line above them says; all are read");
        if (shape_.countFirst)
            for (std::size_t f = 0; f < table_.fields.size(); ++f)
                if (table_.fields[f].name == "intensity" && ranges[f].min < 0)
                    table_.fields[f].meaning = TableField::Meaning::signedIntensity;
    }

  private:
    static constexpr std::uint64_t laterStretch = ~std::uint64_t{0}; // as RowPlace::section
    static bool isLaterStretch(const RowPlace& place) { return place.section == laterStretch; }

    // Where the first line that begins behind `at` begins; nothing if that is far, or can't be read.
    std::optional<std::uint64_t> lineBehind(std::uint64_t at) const {
        constexpr std::uint64_t pieceBytes = std::uint64_t{1} << 14;
        for (const std::uint64_t end = at + TextLines::longestLine; at < end; at += pieceBytes) {
            auto piece = source_.read({at, pieceBytes});
            if (!piece)
                return std::nullopt;
            auto found = std::find(piece->begin(), piece->end(), '\n');
            if (found != piece->end())
                return at + static_cast<std::uint64_t>(found - piece->begin()) + 1;
        }
        return std::nullopt;
    }

    Status nameColumns(const std::string& wanted) {
        std::vector<std::string> names = shape_.names;
        const std::size_t count = shape_.isNumber.size();
        std::string by = "the header names";
        if (!wanted.empty()) {
            names.clear();
            for (const std::string& name : splitLine(wanted, ','))
                names.push_back(unquoted(name));
            by = "--columns names";
        }
        areNamed_ = !names.empty();
        if (count > mostColumns)
            return Error{ErrorCode::limitExceeded, cat("there are more than ", mostColumns, " columns"),
                         source_.name(), ""};
        if (areNamed_ && names.size() != count)
            return Error{wanted.empty() ? ErrorCode::corrupt : ErrorCode::invalidArgument,
                         cat(by, " ", names.size(), " columns, but the first line of data has ", count),
                         cat(source_.name(), ", line ", begin_.line),
                         "name every column with --columns, those to skip with -"};
        std::array<int, 3> position{-1, -1, -1};
        for (std::size_t c = 0; c < count; ++c) {
            const bool isSkipped = !shape_.isNumber[c] || (areNamed_ && names[c] == "-");
            if (isSkipped && !(areNamed_ && names[c] == "-"))
                table_.warnings.push_back(cat("column ", c + 1, areNamed_ ? " (" + names[c] + ")" : "",
                                              " holds text and is not read"));
            lineFormat_.columns.push_back(
                {isSkipped ? TextColumn::Kind::skip : TextColumn::Kind::number, table_.fields.size(), 0});
            if (isSkipped)
                continue;
            auto axis = areNamed_ ? axisOfName(names[c]) : c < 3 ? std::optional(c) : std::nullopt;
            if (axis && position[*axis] < 0)
                position[*axis] = static_cast<int>(table_.fields.size());
            table_.fields.push_back({areNamed_ ? names[c]
                                     : axis    ? std::string(1, "xyz"[*axis])
                                               : cat("column ", c + 1),
                                     std::nullopt, 1, true});
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (position[axis] < 0)
                return Error{wanted.empty() ? ErrorCode::corrupt : ErrorCode::invalidArgument,
                             cat("no column of numbers is named ", std::string(1, "xyz"[axis])),
                             source_.name(), "name them with --columns x,y,z,…"};
            table_.position[axis] = static_cast<std::size_t>(position[axis]);
        }
        return {};
    }

    void guessFrom(const std::vector<FieldRange>& ranges) {
        std::vector<std::string> names = guessNames(ranges);
        for (std::size_t f = 0; f < names.size(); ++f)
            table_.fields[f].name = names[f];
    }

    std::unique_ptr<SharedSource> owned_;
    SharedSource& source_;
    mutable Findings findings_;
    TextShape shape_;
    Table table_;
    LineFormat lineFormat_;
    RowPlace begin_;
    bool areNamed_ = false;
};
} // namespace

bool looksLikeText(std::string_view start, bool anyHeader) {
    std::string_view lines = wholeLines(start, start.size() < startBytes);
    return guessTextShape(lines, anyHeader).has_value();
}

Result<std::unique_ptr<PointInput>>
openTextInput(const std::string& path, std::unique_ptr<SharedSource> source, const InputOptions& options) {
    auto format = std::make_unique<TextFormat>(std::move(source));
    STIPPLE_CHECK(format->open(options));
    return openTable(path, std::move(format), options);
}

} // namespace stipple
