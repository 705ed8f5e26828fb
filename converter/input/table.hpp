// A file whose points are rows of named columns: PLY, PCD, PTX and text. A format says what its columns are
// and reads rows; everything else (grid, LAS names and types, parts, points that are left out) is common.
//
//   TableFormat  →  RowReader  →  Rows  →  measured once (table_measure.hpp), then made points
//   (table_input.cpp)
#pragma once

#include "converter/input/open.hpp"
#include "converter/input/shared_source.hpp"
#include "converter/input/text_number.hpp"
#include "shared/base/bytes.hpp"
#include "shared/points/attribute.hpp"

#include <array>
#include <optional>

namespace stipple {

// A column of the file.
struct TableField {
    std::string name; // as the file has it
    // How rows hold it; of a column of text, its declared type, or nothing where its values decide.
    std::optional<AttributeType> type;
    int components = 1;
    bool isText = false; // rows hold Numbers instead of values
    // The meaning where the name alone does not tell it.
    enum class Meaning : std::uint8_t { byName, packedRgb, packedRgba, signedIntensity, leftOut };
    Meaning meaning = Meaning::byName;

    std::size_t bytesPerRow() const {
        return (isText ? sizeof(Number) : attributeTypeSize(*type)) * static_cast<std::size_t>(components);
    }
};

// Rows in memory, column after column.
struct Rows {
    std::size_t count = 0;
    std::vector<Bytes> columns; // parallel to Table::fields; values in this machine's order, or Numbers
    // Rows that the file itself marks as no points; empty where it marks none.
    std::vector<std::uint8_t> invalid;

    void resize(const std::vector<TableField>& fields, std::size_t rowCount) {
        count = rowCount;
        columns.resize(fields.size());
        for (std::size_t f = 0; f < fields.size(); ++f)
            columns[f].resize(rowCount * fields[f].bytesPerRow());
        invalid.clear();
    }
    Number number(std::size_t field, std::size_t index) const {
        return loadLe<Number>(columns[field].data() + index * sizeof(Number));
    }
    void setNumber(std::size_t field, std::size_t index, const Number& number) {
        storeLe(columns[field].data() + index * sizeof(Number), number);
    }
};
inline constexpr std::size_t rowsPerBlock = 4096;

// Where rows can be entered.
struct RowPlace {
    std::uint64_t offset = 0; // byte, or whatever the format counts
    std::uint64_t row = 0;    // rows before it
    std::uint64_t line = 1;   // of text
    // Of files in sections, which begin with a header of their own:
    std::uint64_t section = 0, rowInSection = 0, sectionOffset = 0;
    // Rows that begin at this byte, or behind it, are not read from here.
    std::uint64_t end = ~std::uint64_t{0};
};

// Places between which the rows can be read apart from each other.
struct RowStretches {
    std::vector<RowPlace> places; // in order; the first is begin()
    // Row and line of the places are those of the file; else of each they count from its own beginning.
    bool areCounted = false;
};
inline constexpr std::uint64_t rowsPerPart = std::uint64_t{1} << 18;

class RowReader {
  public:
    virtual ~RowReader() = default;
    // Replaces `rows` by the next ones, at most `most`; none is the end.
    virtual Status next(Rows& rows, std::size_t most) = 0;
    // Of the row that comes next.
    virtual RowPlace place() const = 0;
};

struct Table {
    std::string format; // "PLY, binary little endian"
    std::vector<TableField> fields;
    std::array<std::size_t, 3> position{}; // fields of x, y, z; one component, all text or none
    // Rows in all, where the file states them truly; else found by reading to the end.
    std::optional<std::uint64_t> rowCount;
    std::vector<std::string> warnings;
};

struct FieldRange; // table_measure.hpp

// One opened file. Thread: any, several at a time, but for finish().
class TableFormat {
  public:
    virtual ~TableFormat() = default;
    virtual const Table& table() const = 0;
    virtual Result<std::unique_ptr<RowReader>> rowsFrom(const RowPlace& place) const = 0;
    // The place of the first row.
    virtual RowPlace begin() const = 0;
    // Where several threads may begin, without reading the rows: the same at every opening. One place: only
    // at the first row.
    virtual RowStretches stretches() const { return {{begin()}}; }
    // Were the stretches well divided? Asked when all have been read: `endOfFirst` is the place behind the
    // first one's rows, `rows` those of all. If not, the rows are read again, one after the other.
    virtual bool areWhole(const RowPlace&, std::uint64_t) const { return true; }
    // Called once when every row has been measured: the last moment to name columns and to warn.
    virtual void finish(const std::vector<FieldRange>&) {}
    // Called behind finish(). Decimals that the coordinates have, where they are not text but were made from
    // it.
    virtual std::optional<int> decimals() const { return {}; }
    virtual SharedSource& source() const = 0;
};

// Reads every row once. Errors name the file (as `path`).
Result<std::unique_ptr<PointInput>> openTable(const std::string& path, std::unique_ptr<TableFormat> format,
                                              const InputOptions& options);

} // namespace stipple
