#include "converter/input/text_rows.hpp"

#include "converter/input/table_values.hpp"
#include "shared/base/text.hpp"

#include <algorithm>

namespace stipple {

namespace {
bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

// The columns of one line, from left to right.
class LineReader {
  public:
    LineReader(TextLines& lines, const LineFormat& format, const std::vector<TableField>& fields)
        : lines_(lines), format_(format), fields_(fields), at_(lines.at()) {}

    Status read(Rows& rows, std::size_t row) {
        const std::size_t count = format_.columns.size();
        for (column_ = 0; column_ < count; ++column_) {
            const TextColumn& column = format_.columns[column_];
            skipBlanks();
            if (*at_ == '\n' && !(emptyIsValue() && column_ > 0 && column_ + 1 == count && behindSeparator_))
                return tooFew();
            if (column.kind == TextColumn::Kind::number) {
                Number number;
                if (!scanNumber(number))
                    return noNumber();
                const TableField& field = fields_[column.field];
                if (field.type && isInteger(*field.type))
                    STIPPLE_CHECK(checkInteger(field, number));
                rows.setNumber(column.field,
                               row * static_cast<std::size_t>(field.components) + column.component, number);
            } else if (column.kind == TextColumn::Kind::skip) {
                skipValue();
            } else {
                STIPPLE_CHECK(skipList());
            }
            STIPPLE_CHECK(passSeparator(column_ + 1 == count));
        }
        skipBlanks();
        if (*at_ != '\n')
            return Error{ErrorCode::corrupt, cat("there are more than ", count, " columns"), lines_.place(),
                         "mend the line, or take it out"};
        lines_.pass(at_ + 1);
        return {};
    }

  private:
    bool emptyIsValue() const { return format_.separator != ' '; }
    bool isSeparator(char c) const { return c == format_.separator && emptyIsValue(); }
    // Blanks that do not separate; a tab that does is none.
    void skipBlanks() {
        while (isBlank(*at_) && !isSeparator(*at_))
            ++at_;
    }
    bool endsValue(char c) const { return c == '\n' || isSeparator(c) || isBlank(c); }

    bool scanNumber(Number& number) {
        if (emptyIsValue() && (isSeparator(*at_) || *at_ == '\n')) {
            number = Number::missing();
            return true;
        }
        const bool quoted = *at_ == '"';
        const char* end = stipple::scanNumber(at_ + (quoted ? 1 : 0), format_.decimalPoint, number);
        if (end == nullptr || (quoted && *end++ != '"') || !endsValue(*end))
            return false;
        at_ = end;
        return true;
    }

    void skipValue() {
        if (*at_ == '"' && emptyIsValue()) {
            const char* end = at_ + 1;
            while (*end != '"' && *end != '\n')
                ++end;
            at_ = *end == '"' ? end + 1 : end;
        }
        while (*at_ != '\n' && !isSeparator(*at_) && (emptyIsValue() || !isBlank(*at_)))
            ++at_;
    }

    Status skipList() {
        Number number;
        if (!scanNumber(number))
            return noNumber();
        WholeNumber count = toWhole(number);
        if (!count.fits || count.value < 0)
            return Error{ErrorCode::corrupt,
                         cat("column ", column_ + 1, ": a list can't have so many values"), lines_.place(),
                         ""};
        for (std::int64_t i = 0; i < count.value; ++i) {
            skipBlanks();
            if (*at_ == '\n')
                return tooFew();
            skipValue();
        }
        return {};
    }

    Status passSeparator(bool last) {
        skipBlanks();
        behindSeparator_ = isSeparator(*at_);
        if (behindSeparator_) { // one behind the last column says nothing
            ++at_;
        } else if (!last && emptyIsValue() && *at_ != '\n') {
            return noNumber();
        }
        return {};
    }

    Status checkInteger(const TableField& field, const Number& number) const {
        WholeNumber whole = toWhole(number);
        IntegerLimits limits = integerLimits(*field.type);
        bool fits = whole.fits && whole.value >= limits.min &&
                    (whole.value < 0 || static_cast<std::uint64_t>(whole.value) <= limits.max);
        if (fits)
            return {};
        return Error{ErrorCode::corrupt,
                     cat("column ", column_ + 1, " (", field.name, "): the value is no ",
                         attributeTypeName(*field.type)),
                     lines_.place(), "the header declares that type"};
    }
    Error tooFew() const {
        return {ErrorCode::corrupt, cat("there are ", column_, " columns of ", format_.columns.size()),
                lines_.place(), "mend the line, or take it out"};
    }
    Error noNumber() const {
        const char* end = at_;
        while (!endsValue(*end) && end - at_ < 20)
            ++end;
        std::string token(at_, end);
        for (char& c : token)
            if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126)
                c = '?';
        return {ErrorCode::corrupt, cat("column ", column_ + 1, ": \"", token, "\" is no number"),
                lines_.place(), "mend the value, or take the line out"};
    }

    TextLines& lines_;
    const LineFormat& format_;
    const std::vector<TableField>& fields_;
    const char* at_;
    std::size_t column_ = 0;
    bool behindSeparator_ = false;
};

class PlainReader final : public RowReader {
  public:
    PlainReader(SharedSource& source, const LineFormat& format, const std::vector<TableField>& fields,
                std::uint64_t rowCount, const RowPlace& place)
        : lines_(source, place.offset, place.line), format_(format), fields_(fields), rowCount_(rowCount),
          row_(place.row) {}

    Status next(Rows& rows, std::size_t most) override {
        most = static_cast<std::size_t>(std::min<std::uint64_t>(most, rowCount_ - row_));
        rows.resize(fields_, most);
        for (std::size_t i = 0; i < most;) {
            STIPPLE_TRY(more, lines_.load());
            if (!more)
                return Error{ErrorCode::truncated,
                             cat("the file ends after ", row_, " of ", rowCount_, " points"), lines_.place(),
                             "was it copied completely?"};
            if (firstByte(lines_) == '\n') {
                passLine(lines_);
                continue;
            }
            STIPPLE_CHECK(readRow(lines_, format_, fields_, rows, i));
            ++row_;
            ++i;
        }
        return {};
    }
    RowPlace place() const override {
        RowPlace place;
        place.offset = lines_.offset();
        place.line = lines_.line();
        place.row = row_;
        return place;
    }

  private:
    TextLines lines_;
    const LineFormat& format_;
    const std::vector<TableField>& fields_;
    std::uint64_t rowCount_, row_;
};
} // namespace

Status readRow(TextLines& lines, const LineFormat& format, const std::vector<TableField>& fields, Rows& rows,
               std::size_t row) {
    return LineReader(lines, format, fields).read(rows, row);
}

char firstByte(const TextLines& lines) {
    const char* at = lines.at();
    while (isBlank(*at))
        ++at;
    return *at;
}

void passLine(TextLines& lines) {
    lines.pass(lines.at() + lineText(lines).size() + 1);
}

std::string_view lineText(const TextLines& lines) {
    const char *at = lines.at(), *end = at; // a line may hold NULs
    while (*end != '\n')
        ++end;
    return {at, static_cast<std::size_t>(end - at)};
}

std::unique_ptr<RowReader> readTextRows(SharedSource& source, const LineFormat& format,
                                        const std::vector<TableField>& fields, std::uint64_t rowCount,
                                        const RowPlace& place) {
    return std::make_unique<PlainReader>(source, format, fields, rowCount, place);
}

} // namespace stipple
