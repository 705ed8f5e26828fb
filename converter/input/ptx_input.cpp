#include "converter/input/ptx_input.hpp"

#include "converter/input/text_guess.hpp"
#include "converter/input/text_rows.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>

namespace stipple {

namespace {

// Fields of the table. Coordinates are made from text here, so they are doubles there.
enum Field : std::size_t { x, y, z, intensity, red, green, blue, scan, fieldCount };

std::vector<TableField> ptxFields() {
    std::vector<TableField> fields(fieldCount);
    fields[x] = {"x", AttributeType::f64};
    fields[y] = {"y", AttributeType::f64};
    fields[z] = {"z", AttributeType::f64};
    fields[intensity] = {"intensity", AttributeType::f32, 1, true};
    fields[red] = {"red", std::nullopt, 1, true};
    fields[green] = {"green", std::nullopt, 1, true};
    fields[blue] = {"blue", std::nullopt, 1, true};
    fields[scan] = {std::string(attribute_names::pointSourceId), AttributeType::u16};
    return fields;
}

// The columns of a line as they are read, before the pose: fields of Numbers only.
std::vector<TableField> lineFields() {
    std::vector<TableField> fields = ptxFields();
    fields.resize(scan);
    for (TableField& field : fields) {
        field.type.reset();
        field.isText = true;
    }
    return fields;
}

std::vector<Field> columnsOf(std::size_t count) {
    switch (count) {
    case 3:
        return {x, y, z};
    case 4:
        return {x, y, z, intensity};
    case 6:
        return {x, y, z, red, green, blue};
    case 7:
        return {x, y, z, intensity, red, green, blue};
    default:
        return {};
    }
}

struct ScanHeader {
    std::uint64_t points = 0;
    double pose[4][4]{}; // as in the file: rows, of which the last is the translation
    LineFormat lines;
};

// What the scans turned out to hold; set by any reader.
struct Findings {
    std::atomic<bool> intensity{false}, colour{false}, scanWithoutColour{false};
    std::atomic<int> decimals{0};

    void addDecimals(const Number& number) {
        int known = decimals.load(std::memory_order_relaxed);
        if (number.mantissa == 0 || -number.exponent <= known)
            return;
        std::int64_t mantissa = number.mantissa;
        int count = -number.exponent;
        for (; count > known && mantissa % 10 == 0; --count)
            mantissa /= 10;
        while (count > known && !decimals.compare_exchange_weak(known, count)) {
        }
    }
};

class PtxReader final : public RowReader {
  public:
    PtxReader(SharedSource& source, const std::vector<TableField>& fields, Findings& findings)
        : source_(source), fields_(fields), lineFields_(lineFields()), findings_(findings) {}

    // Goes to a place that another reader noted.
    Status enter(const RowPlace& place) {
        if (place.section > 0) {
            lines_ = std::make_unique<TextLines>(source_, place.sectionOffset, 1);
            place_ = place;
            STIPPLE_CHECK(readHeader());
        }
        lines_ = std::make_unique<TextLines>(source_, place.offset, place.line);
        place_ = place;
        return {};
    }

    Status next(Rows& rows, std::size_t most) override {
        raw_.resize(lineFields_, most);
        rows.resize(fields_, most);
        rows.invalid.assign(most, 0);
        std::size_t filled = 0;
        while (filled < most && !isAtEnd()) {
            if (place_.section == 0 || place_.rowInSection == header_.points) {
                STIPPLE_TRY(begins, beginScan());
                if (!begins)
                    break;
                continue;
            }
            STIPPLE_TRY(more, lines_->load());
            if (!more)
                return Error{ErrorCode::truncated,
                             cat("scan ", place_.section, " ends after ", place_.rowInSection, " of ",
                                 header_.points, " points"),
                             lines_->place(), "was the file copied completely?"};
            if (firstByte(*lines_) == '\n') {
                passLine(*lines_);
                continue;
            }
            STIPPLE_CHECK(readRow(*lines_, header_.lines, lineFields_, raw_, filled));
            finishRow(rows, filled);
            ++place_.row;
            ++place_.rowInSection;
            ++filled;
        }
        cut(rows, filled);
        return {};
    }
    // Goes past `count` rows, of which only the ends of their lines are looked for; false where there are
    // fewer.
    Result<bool> pass(std::uint64_t count) {
        while (count > 0) {
            if (place_.section == 0 || place_.rowInSection == header_.points) {
                STIPPLE_TRY(begins, beginScan());
                if (!begins)
                    return false;
                continue;
            }
            STIPPLE_TRY(more, lines_->load());
            if (!more)
                return false;
            if (firstByte(*lines_) != '\n') {
                ++place_.row;
                ++place_.rowInSection;
                --count;
            }
            passLine(*lines_);
        }
        return true;
    }
    bool isInsideScan() const { return place_.rowInSection < header_.points; }

    RowPlace place() const override {
        RowPlace place = place_;
        place.offset = lines_->offset();
        place.line = lines_->line();
        return place;
    }

  private:
    bool isAtEnd() const { return place_.row > 0 && lines_->offset() >= place_.end; }

    // The next scan; false at the end of the file.
    Result<bool> beginScan() {
        for (;;) {
            STIPPLE_TRY(more, lines_->load());
            if (!more)
                return false;
            if (firstByte(*lines_) != '\n')
                break;
            passLine(*lines_);
        }
        constexpr std::uint64_t mostScans = 65535;
        if (place_.section == mostScans)
            return Error{ErrorCode::limitExceeded, cat("there are more than ", mostScans, " scans"),
                         lines_->place(), "divide the file"};
        place_.sectionOffset = lines_->offset();
        ++place_.section;
        place_.rowInSection = 0;
        STIPPLE_CHECK(readHeader());
        return true;
    }

    Status readHeader() {
        header_ = ScanHeader{};
        std::vector<double> numbers;
        STIPPLE_TRY(columns, readCount());
        STIPPLE_TRY(rows, readCount());
        if (__builtin_mul_overflow(columns, rows, &header_.points))
            return damaged("columns x rows is too large");
        for (int i = 0; i < 4; ++i)
            STIPPLE_CHECK(readNumbers(3, numbers, false));
        for (auto& row : header_.pose) {
            STIPPLE_CHECK(readNumbers(4, numbers, &row == &header_.pose[3]));
            std::copy(numbers.begin(), numbers.end(), row);
        }
        return header_.points > 0 ? readColumns() : Status{};
    }

    Result<std::uint64_t> readCount() {
        STIPPLE_TRY(line, headerLine());
        std::uint64_t count = 0;
        std::vector<std::string> values = splitLine(line, ' ');
        if (values.size() == 1) {
            const std::string& value = values[0];
            auto read = std::from_chars(value.data(), value.data() + value.size(), count);
            if (read.ec == std::errc{} && read.ptr == value.data() + value.size()) {
                passLine(*lines_);
                return count;
            }
        }
        return damaged("a scan begins with its numbers of columns and rows");
    }

    Status readNumbers(std::size_t count, std::vector<double>& numbers, bool isTranslation) {
        STIPPLE_TRY(line, headerLine());
        numbers.clear();
        for (std::string value : splitLine(line, ' ')) {
            value += '\n';
            Number number;
            const char* end = scanNumber(value.c_str(), '.', number);
            if (end == nullptr || *end != '\n' || !number.isFinite())
                return damaged("the pose of a scan is made of finite numbers");
            if (isTranslation)
                findings_.addDecimals(number);
            numbers.push_back(toDouble(number));
        }
        if (numbers.size() != count)
            return damaged(cat("this line of a scan's pose should have ", count, " numbers"));
        passLine(*lines_);
        return {};
    }

    // The first point of a scan says which columns it has.
    Status readColumns() {
        STIPPLE_TRY(line, headerLine());
        std::vector<Field> columns = columnsOf(splitLine(line, ' ').size());
        if (columns.empty())
            return damaged("points have x y z, then intensity, then red green blue");
        for (Field field : columns)
            header_.lines.columns.push_back({TextColumn::Kind::number, field, 0});
        auto has = [&](Field field) {
            return std::find(columns.begin(), columns.end(), field) != columns.end();
        };
        hasIntensity_ = has(intensity);
        hasColour_ = has(red);
        if (hasIntensity_)
            findings_.intensity = true;
        (hasColour_ ? findings_.colour : findings_.scanWithoutColour) = true;
        return {};
    }

    Result<std::string_view> headerLine() {
        STIPPLE_TRY(more, lines_->load());
        if (!more)
            return Error{ErrorCode::truncated, cat("scan ", place_.section, " ends within its header"),
                         lines_->place(), "was the file copied completely?"};
        return lineText(*lines_);
    }

    // From the columns of the line to those of the table.
    void finishRow(Rows& rows, std::size_t i) {
        double local[3];
        bool isNull = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Number number = raw_.number(axis, i);
            local[axis] = toDouble(number);
            isNull = isNull && local[axis] == 0;
            if (number.isFinite())
                findings_.addDecimals(number);
        }
        rows.invalid[i] = isNull ? 1 : 0;
        const auto& m = header_.pose;
        for (std::size_t axis = 0; axis < 3; ++axis)
            storeLe(rows.columns[axis].data() + i * sizeof(double),
                    local[0] * m[0][axis] + local[1] * m[1][axis] + local[2] * m[2][axis] + m[3][axis]);
        rows.setNumber(intensity, i, hasIntensity_ ? raw_.number(intensity, i) : Number{});
        for (Field field : {red, green, blue})
            rows.setNumber(field, i, hasColour_ ? raw_.number(field, i) : Number{});
        storeLe(rows.columns[scan].data() + i * sizeof(std::uint16_t),
                static_cast<std::uint16_t>(place_.section));
    }

    void cut(Rows& rows, std::size_t count) const {
        std::vector<std::uint8_t> invalid = std::move(rows.invalid);
        invalid.resize(count);
        rows.resize(fields_, count);
        rows.invalid = std::move(invalid);
    }

    Error damaged(const std::string& what) const {
        return {ErrorCode::corrupt, what, lines_->place(), "the file is damaged, or of no PTX file"};
    }

    SharedSource& source_;
    std::unique_ptr<TextLines> lines_;
    const std::vector<TableField>& fields_;
    const std::vector<TableField> lineFields_;
    Findings& findings_;
    ScanHeader header_; // of scan number place_.section
    bool hasIntensity_ = false, hasColour_ = false;
    RowPlace place_;
    Rows raw_;
};

class PtxFormat final : public TableFormat {
  public:
    explicit PtxFormat(std::unique_ptr<SharedSource> source) : owned_(std::move(source)), source_(*owned_) {
        table_.format = "PTX";
        table_.fields = ptxFields();
        table_.position = {x, y, z};
    }

    const Table& table() const override { return table_; }
    RowPlace begin() const override { return {}; }
    SharedSource& source() const override { return source_; }
    std::optional<int> decimals() const override { return findings_.decimals.load(); }

    Result<std::unique_ptr<RowReader>> rowsFrom(const RowPlace& place) const override {
        auto reader = std::make_unique<PtxReader>(source_, table_.fields, findings_);
        STIPPLE_CHECK(reader->enter(place));
        return std::unique_ptr<RowReader>(std::move(reader));
    }

    // The lines have to be counted to know where scans begin, which takes a tenth of the time of reading
    // them.
    RowStretches stretches() const override {
        RowStretches result{{begin()}, true};
        PtxReader reader(source_, table_.fields, findings_);
        if (!reader.enter(begin()))
            return {{begin()}};
        for (;;) {
            auto more = reader.pass(rowsPerPart);
            if (!more) // what is wrong is said where the rows are read
                return {{begin()}};
            if (!*more)
                return result;
            // Between two scans there may be empty lines, which are no one's.
            if (!reader.isInsideScan())
                continue;
            RowPlace place = reader.place();
            result.places.back().end = place.offset;
            result.places.push_back(place);
        }
    }

    void finish(const std::vector<FieldRange>&) override {
        if (!findings_.intensity)
            table_.fields[intensity].meaning = TableField::Meaning::leftOut;
        for (Field field : {red, green, blue})
            if (!findings_.colour)
                table_.fields[field].meaning = TableField::Meaning::leftOut;
        if (findings_.colour && findings_.scanWithoutColour)
            table_.warnings.push_back("some scans have no colours; their points are black");
    }

  private:
    std::unique_ptr<SharedSource> owned_;
    SharedSource& source_;
    mutable Findings findings_;
    Table table_;
};
} // namespace

bool looksLikePtx(std::string_view start) {
    constexpr std::size_t headerLines = 10;
    constexpr std::size_t counts[headerLines] = {1, 1, 3, 3, 3, 3, 4, 4, 4, 4};
    for (std::size_t line = 0; line < headerLines; ++line) {
        std::size_t end = start.find_first_of("\r\n");
        if (end == std::string_view::npos)
            return false;
        std::vector<std::string> values = splitLine(start.substr(0, end), ' ');
        if (values.size() != counts[line])
            return false;
        for (std::string& value : values) {
            value += '\n';
            Number number;
            const char* behind = scanNumber(value.c_str(), '.', number);
            if (behind == nullptr || *behind != '\n')
                return false;
        }
        end += start.substr(end).starts_with("\r\n") ? 2 : 1;
        start.remove_prefix(end);
    }
    return true;
}

Result<std::unique_ptr<PointInput>>
openPtxInput(const std::string& path, std::unique_ptr<SharedSource> source, const InputOptions& options) {
    return openTable(path, std::make_unique<PtxFormat>(std::move(source)), options);
}

} // namespace stipple
