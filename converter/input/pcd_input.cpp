#include "converter/input/pcd_input.hpp"

#include "converter/input/pcd_header.hpp"
#include "converter/input/pcd_lzf.hpp"
#include "converter/input/record_rows.hpp"
#include "converter/input/text_rows.hpp"
#include "shared/base/text.hpp"

#include <algorithm>

namespace stipple {

namespace {
// Columns of a compressed file: field after field, each with the values of all points.
struct PackedColumns {
    static constexpr std::uint64_t rowsPerPlace = std::uint64_t{1} << 18; // as of parts

    std::uint64_t rows = 0;
    std::uint64_t fileEnd = 0, outputEnd = 0;
    std::vector<std::uint64_t> begins;         // of each field, in the decoded bytes
    std::vector<std::vector<LzfPlace>> places; // of each field, every rowsPerPlace rows
};

class PackedReader final : public RowReader {
  public:
    PackedReader(SharedSource& source, const PackedColumns& packed, const std::vector<TableField>& fields,
                 const RowPlace& place)
        : packed_(packed), fields_(fields), row_(place.row) {
        for (std::size_t f = 0; f < fields.size() && row_ < packed.rows; ++f)
            decoders_.emplace_back(source,
                                   packed.places[f][static_cast<std::size_t>(row_ / packed.rowsPerPlace)],
                                   packed.fileEnd, packed.outputEnd);
    }

    Status next(Rows& rows, std::size_t most) override {
        std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(most, packed_.rows - row_));
        rows.resize(fields_, count);
        for (std::size_t f = 0; count > 0 && f < fields_.size(); ++f) {
            LzfDecoder& decoder = decoders_[f];
            std::uint64_t begin = packed_.begins[f] + row_ * fields_[f].bytesPerRow();
            STIPPLE_CHECK(decoder.read(nullptr, begin - decoder.outputOffset()));
            STIPPLE_CHECK(decoder.read(rows.columns[f].data(), rows.columns[f].size()));
        }
        row_ += count;
        return {};
    }
    RowPlace place() const override {
        RowPlace place;
        place.row = row_;
        return place;
    }

  private:
    const PackedColumns& packed_;
    const std::vector<TableField>& fields_;
    std::uint64_t row_;
    std::vector<LzfDecoder> decoders_;
};

class PcdFormat final : public TableFormat {
  public:
    explicit PcdFormat(std::unique_ptr<SharedSource> source) : owned_(std::move(source)), source_(*owned_) {}

    Status open() {
        STIPPLE_TRY(header, readPcdHeader(source_));
        header_ = std::move(header);
        STIPPLE_CHECK(describeFields());
        if (!header_.viewpoint.empty())
            table_.warnings.push_back(cat("VIEWPOINT ", header_.viewpoint,
                                          " is the sensor's pose; the points are not moved by it"));
        begin_.offset = header_.bodyOffset;
        begin_.line = header_.bodyLine;
        if (header_.encoding == PcdEncoding::binary)
            return findRecords();
        if (header_.encoding == PcdEncoding::compressed)
            return findColumns();
        return {};
    }

    const Table& table() const override { return table_; }
    RowPlace begin() const override { return begin_; }
    SharedSource& source() const override { return source_; }

    Result<std::unique_ptr<RowReader>> rowsFrom(const RowPlace& place) const override {
        switch (header_.encoding) {
        case PcdEncoding::ascii:
            return readTextRows(source_, lineFormat_, table_.fields, header_.points, place);
        case PcdEncoding::binary:
            return readRecords(source_, layout_, table_.fields, place);
        case PcdEncoding::compressed:
            break;
        }
        return std::unique_ptr<RowReader>(
            std::make_unique<PackedReader>(source_, packed_, table_.fields, place));
    }

  private:
    Status describeFields() {
        const bool isText = header_.encoding == PcdEncoding::ascii;
        table_.format = isText                                    ? "PCD, ASCII"
                        : header_.encoding == PcdEncoding::binary ? "PCD, binary"
                                                                  : "PCD, compressed";
        table_.rowCount = header_.points;
        std::array<int, 3> position{-1, -1, -1};
        for (const PcdField& field : header_.fields) {
            const std::size_t index = table_.fields.size();
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (position[axis] < 0 && field.count == 1 && field.name.size() == 1 &&
                    (field.name[0] == "xyz"[axis] || field.name[0] == "XYZ"[axis]))
                    position[axis] = static_cast<int>(index);
            for (int i = 0; i < field.count; ++i)
                lineFormat_.columns.push_back(
                    {field.isPadding() ? TextColumn::Kind::skip : TextColumn::Kind::number, index,
                     static_cast<std::size_t>(i)});
            if (!field.isPadding()) {
                table_.fields.push_back({field.name, field.type, field.count, isText, meaningOf(field)});
                layout_.offsets.push_back(layout_.recordBytes);
            }
            layout_.recordBytes += field.bytes();
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (position[axis] < 0)
                return Error{ErrorCode::corrupt,
                             cat("there is no field \"", std::string(1, "xyz"[axis]), "\""), source_.name(),
                             "points need x, y and z"};
            table_.position[axis] = static_cast<std::size_t>(position[axis]);
        }
        return {};
    }

    static TableField::Meaning meaningOf(const PcdField& field) {
        if (attributeTypeSize(field.type) != sizeof(std::uint32_t) || field.count != 1)
            return TableField::Meaning::byName;
        return field.name == "rgb"    ? TableField::Meaning::packedRgb
               : field.name == "rgba" ? TableField::Meaning::packedRgba
                                      : TableField::Meaning::byName;
    }

    Status findRecords() {
        layout_.begin = header_.bodyOffset;
        layout_.count = header_.points;
        const std::uint64_t held = source_.sizeBytes() - layout_.begin;
        if (layout_.count > held / layout_.recordBytes)
            return Error{ErrorCode::truncated,
                         cat("the header promises ", layout_.count, " points of ", layout_.recordBytes,
                             " bytes, but the file has only ", held, " bytes for them"),
                         source_.name(), "was it copied completely?"};
        return {};
    }

    // u32 compressed bytes, u32 decoded bytes, the compressed bytes; fields named "_" are not among them.
    Status findColumns() {
        FileCursor cursor(source_, header_.bodyOffset);
        constexpr std::size_t sizesBytes = 8;
        STIPPLE_TRY(sizes, cursor.peek(sizesBytes));
        if (sizes.size() < sizesBytes)
            return truncated("the sizes of the compressed points are missing");
        const std::uint64_t compressed = loadLe<std::uint32_t>(sizes.data());
        const std::uint64_t decoded = loadLe<std::uint32_t>(sizes.data() + 4);
        LzfPlace start;
        start.fileOffset = header_.bodyOffset + sizesBytes;
        if (compressed > source_.sizeBytes() - start.fileOffset)
            return truncated(cat("the header promises ", compressed,
                                 " compressed bytes, but the file has only ",
                                 source_.sizeBytes() - start.fileOffset));
        std::uint64_t rowBytes = 0;
        for (const TableField& field : table_.fields)
            rowBytes += field.bytesPerRow();
        if (header_.points > decoded || header_.points * rowBytes != decoded)
            return Error{ErrorCode::corrupt,
                         cat(header_.points, " points of ", rowBytes, " bytes are not the ", decoded,
                             " bytes that are compressed"),
                         cat(source_.name(), ", byte ", header_.bodyOffset), "the file is damaged"};
        packed_.rows = header_.points;
        packed_.fileEnd = start.fileOffset + compressed;
        packed_.outputEnd = decoded;
        return notePlaces(start);
    }

    Status notePlaces(const LzfPlace& start) {
        LzfDecoder decoder(source_, start, packed_.fileEnd, packed_.outputEnd);
        for (const TableField& field : table_.fields) {
            packed_.begins.push_back(decoder.outputOffset());
            std::vector<LzfPlace>& places = packed_.places.emplace_back();
            for (std::uint64_t row = 0; row < packed_.rows; row += packed_.rowsPerPlace) {
                places.push_back(decoder.place());
                std::uint64_t rows = std::min(packed_.rowsPerPlace, packed_.rows - row);
                STIPPLE_CHECK(decoder.read(nullptr, rows * field.bytesPerRow()));
            }
        }
        return {};
    }

    Error truncated(const std::string& what) const {
        return {ErrorCode::truncated, what, cat(source_.name(), ", byte ", header_.bodyOffset),
                "was it copied completely?"};
    }

    std::unique_ptr<SharedSource> owned_;
    SharedSource& source_;
    PcdHeader header_;
    Table table_;
    LineFormat lineFormat_;
    RecordLayout layout_;
    PackedColumns packed_;
    RowPlace begin_;
};
} // namespace

Result<std::unique_ptr<PointInput>>
openPcdInput(const std::string& path, std::unique_ptr<SharedSource> source, const InputOptions& options) {
    auto format = std::make_unique<PcdFormat>(std::move(source));
    STIPPLE_CHECK(format->open());
    return openTable(path, std::move(format), options);
}

} // namespace stipple
