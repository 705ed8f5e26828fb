#include "converter/input/ply_input.hpp"

#include "converter/input/ply_header.hpp"
#include "converter/input/record_rows.hpp"
#include "converter/input/table_values.hpp"
#include "converter/input/text_rows.hpp"
#include "shared/base/text.hpp"

#include <algorithm>

namespace stipple {

namespace {
template <class T>
T valueOf(const std::uint8_t* from, bool bigEndian) {
    std::array<std::uint8_t, sizeof(T)> bytes;
    std::copy_n(from, sizeof(T), bytes.begin());
    if (bigEndian)
        std::reverse(bytes.begin(), bytes.end());
    return loadLe<T>(bytes.data());
}

// Walks over binary elements that hold lists, one after the other.
class BinaryWalker {
  public:
    BinaryWalker(SharedSource& source, std::uint64_t offset, bool bigEndian)
        : cursor_(source, offset), fileBytes_(source.sizeBytes()), name_(source.name()),
          bigEndian_(bigEndian) {}

    // Passes one element. `take(property, bytes)` is called with each value that is no list.
    template <class Take>
    Status pass(const PlyElement& element, const Take& take) {
        for (std::size_t p = 0; p < element.properties.size(); ++p) {
            const PlyProperty& property = element.properties[p];
            if (property.listCountType) {
                STIPPLE_CHECK(passList(property));
                continue;
            }
            std::size_t size = attributeTypeSize(property.type);
            STIPPLE_TRY(bytes, need(size));
            take(p, bytes.data());
            cursor_.skip(size);
        }
        return {};
    }
    Status passBytes(std::uint64_t count) {
        if (count > fileBytes_ - cursor_.offset())
            return ends();
        cursor_.skip(count);
        return {};
    }
    std::uint64_t offset() const { return cursor_.offset(); }
    bool bigEndian() const { return bigEndian_; }

  private:
    Status passList(const PlyProperty& property) {
        std::size_t size = attributeTypeSize(*property.listCountType);
        STIPPLE_TRY(bytes, need(size));
        std::uint64_t count = 0;
        bool negative = false;
        visitType(*property.listCountType, [&](auto zero) {
            auto value = valueOf<decltype(zero)>(bytes.data(), bigEndian_);
            negative = value < 0;
            count = negative ? 0 : static_cast<std::uint64_t>(value);
        });
        if (negative)
            return Error{ErrorCode::corrupt, cat("the list \"", property.name, "\" has a negative length"),
                         cat(name_, ", byte ", cursor_.offset()), "the file is damaged"};
        cursor_.skip(size);
        std::uint64_t valueBytes = attributeTypeSize(property.type);
        if (count > (fileBytes_ - cursor_.offset()) / valueBytes)
            return ends();
        return passBytes(count * valueBytes);
    }

    Result<ByteSpan> need(std::size_t size) {
        STIPPLE_TRY(bytes, cursor_.peek(size));
        if (bytes.size() < size)
            return ends();
        return bytes;
    }
    Error ends() const {
        return {ErrorCode::truncated, "the file ends within its elements",
                cat(name_, ", byte ", std::min(fileBytes_, cursor_.offset())), "was it copied completely?"};
    }

    FileCursor cursor_;
    std::uint64_t fileBytes_;
    std::string name_;
    bool bigEndian_;
};

// Bytes of one element, where it holds no list.
std::optional<std::uint64_t> recordBytes(const PlyElement& element) {
    std::uint64_t bytes = 0;
    for (const PlyProperty& property : element.properties) {
        if (property.listCountType)
            return {};
        bytes += attributeTypeSize(property.type);
    }
    return bytes;
}

// Vertices that hold lists, in binary: one after the other.
class WalkedReader final : public RowReader {
  public:
    WalkedReader(SharedSource& source, bool bigEndian, const PlyElement& vertex,
                 const std::vector<int>& fieldOf, const std::vector<TableField>& fields,
                 const RowPlace& place)
        : walker_(source, place.offset, bigEndian), vertex_(vertex), fieldOf_(fieldOf), fields_(fields),
          row_(place.row) {}

    Status next(Rows& rows, std::size_t most) override {
        std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(most, vertex_.count - row_));
        rows.resize(fields_, count);
        for (std::size_t i = 0; i < count; ++i) {
            STIPPLE_CHECK(walker_.pass(vertex_, [&](std::size_t property, const std::uint8_t* from) {
                std::size_t f = static_cast<std::size_t>(fieldOf_[property]);
                std::size_t size = attributeTypeSize(*fields_[f].type);
                gatherColumn(from, 0, 1, size, 1, walker_.bigEndian(), rows.columns[f].data() + i * size);
            }));
            ++row_;
        }
        return {};
    }
    RowPlace place() const override {
        RowPlace place;
        place.offset = walker_.offset();
        place.row = row_;
        return place;
    }

  private:
    BinaryWalker walker_;
    const PlyElement& vertex_;
    const std::vector<int>& fieldOf_;
    const std::vector<TableField>& fields_;
    std::uint64_t row_;
};

class PlyFormat final : public TableFormat {
  public:
    explicit PlyFormat(std::unique_ptr<SharedSource> source) : owned_(std::move(source)), source_(*owned_) {}

    Status open() {
        STIPPLE_TRY(header, readPlyHeader(source_));
        header_ = std::move(header);
        for (std::size_t e = 0; e < header_.elements.size(); ++e)
            if (header_.elements[e].name == "vertex")
                vertexIndex_ = e;
        STIPPLE_CHECK(describeFields());
        warn();
        STIPPLE_CHECK(isText() ? findTextBody() : findBinaryBody());
        return {};
    }

    const Table& table() const override { return table_; }
    RowPlace begin() const override { return begin_; }
    SharedSource& source() const override { return source_; }

    Result<std::unique_ptr<RowReader>> rowsFrom(const RowPlace& place) const override {
        if (isText())
            return readTextRows(source_, lineFormat_, table_.fields, vertex().count, place);
        if (isFixedSize_)
            return readRecords(source_, layout_, table_.fields, place);
        return std::unique_ptr<RowReader>(
            std::make_unique<WalkedReader>(source_, isBigEndian(), vertex(), fieldOf_, table_.fields, place));
    }

  private:
    const PlyElement& vertex() const { return header_.elements[vertexIndex_]; }
    bool isText() const { return header_.encoding == PlyEncoding::ascii; }
    bool isBigEndian() const { return header_.encoding == PlyEncoding::bigEndian; }

    Status describeFields() {
        table_.format = isText()        ? "PLY, ASCII"
                        : isBigEndian() ? "PLY, binary big endian"
                                        : "PLY, binary little endian";
        table_.rowCount = vertex().count;
        std::array<int, 3> position{-1, -1, -1};
        std::size_t offset = 0;
        for (const PlyProperty& property : vertex().properties) {
            fieldOf_.push_back(property.listCountType ? -1 : static_cast<int>(table_.fields.size()));
            TextColumn column{TextColumn::Kind::list, table_.fields.size(), 0};
            if (!property.listCountType) {
                column.kind = TextColumn::Kind::number;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    if (position[axis] < 0 && isAxis(property.name, axis))
                        position[axis] = fieldOf_.back();
                table_.fields.push_back({property.name, property.type, 1, isText()});
                layout_.offsets.push_back(offset);
                offset += attributeTypeSize(property.type);
            }
            lineFormat_.columns.push_back(column);
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (position[axis] < 0)
                return Error{ErrorCode::corrupt,
                             cat("the vertices have no property \"", std::string(1, "xyz"[axis]), "\""),
                             source_.name(), "points need x, y and z"};
            table_.position[axis] = static_cast<std::size_t>(position[axis]);
        }
        return {};
    }
    static bool isAxis(const std::string& name, std::size_t axis) {
        return name.size() == 1 && (name[0] == "xyz"[axis] || name[0] == "XYZ"[axis]);
    }

    void warn() {
        for (const PlyElement& element : header_.elements)
            if (element.name != "vertex" && element.count > 0)
                table_.warnings.push_back(
                    cat("only the vertices are read; ", element.count, " of \"", element.name, "\" are not"));
        for (const PlyProperty& property : vertex().properties)
            if (property.listCountType)
                table_.warnings.push_back(
                    cat("the list \"", property.name, "\" of the vertices is not read"));
    }

    Status findTextBody() {
        TextLines lines(source_, header_.bodyOffset, header_.bodyLine);
        for (std::size_t e = 0; e < vertexIndex_; ++e)
            for (std::uint64_t i = 0; i < header_.elements[e].count; ++i) {
                STIPPLE_TRY(more, lines.load());
                if (!more)
                    return Error{ErrorCode::truncated, "the file ends before its vertices", lines.place(),
                                 "was it copied completely?"};
                passLine(lines);
            }
        begin_.offset = lines.offset();
        begin_.line = lines.line();
        return {};
    }

    Status findBinaryBody() {
        BinaryWalker walker(source_, header_.bodyOffset, isBigEndian());
        for (std::size_t e = 0; e < vertexIndex_; ++e)
            STIPPLE_CHECK(passElements(walker, header_.elements[e]));
        begin_.offset = walker.offset();
        std::optional<std::uint64_t> bytes = recordBytes(vertex());
        isFixedSize_ = bytes.has_value();
        if (!isFixedSize_)
            return {};
        layout_.begin = begin_.offset;
        layout_.count = vertex().count;
        layout_.recordBytes = static_cast<std::size_t>(*bytes);
        layout_.bigEndian = isBigEndian();
        std::uint64_t held = source_.sizeBytes() - begin_.offset;
        if (layout_.count > held / *bytes)
            return Error{ErrorCode::truncated,
                         cat("the header promises ", layout_.count, " vertices of ", *bytes,
                             " bytes, but the file has only ", held, " bytes for them"),
                         source_.name(), "was it copied completely?"};
        return {};
    }

    static Status passElements(BinaryWalker& walker, const PlyElement& element) {
        if (std::optional<std::uint64_t> bytes = recordBytes(element)) {
            std::uint64_t all;
            if (__builtin_mul_overflow(*bytes, element.count, &all))
                all = ~std::uint64_t{0};
            return walker.passBytes(all);
        }
        for (std::uint64_t i = 0; i < element.count; ++i)
            STIPPLE_CHECK(walker.pass(element, [](std::size_t, const std::uint8_t*) {}));
        return {};
    }

    std::unique_ptr<SharedSource> owned_;
    SharedSource& source_;
    PlyHeader header_;
    std::size_t vertexIndex_ = 0;
    Table table_;
    std::vector<int> fieldOf_; // of each property; -1: a list
    LineFormat lineFormat_;
    RecordLayout layout_;
    bool isFixedSize_ = false;
    RowPlace begin_;
};
} // namespace

Result<std::unique_ptr<PointInput>>
openPlyInput(const std::string& path, std::unique_ptr<SharedSource> source, const InputOptions& options) {
    auto format = std::make_unique<PlyFormat>(std::move(source));
    STIPPLE_CHECK(format->open());
    return openTable(path, std::move(format), options);
}

} // namespace stipple
