#include "shared/las/las_writer.hpp"

#include "shared/base/text.hpp"
#include "shared/io/output_file.hpp"
#include "shared/las/extra_bytes.hpp"
#include "shared/las/header_block.hpp"
#include "shared/las/las_records.hpp"
#include "shared/las/laz/chunk_writer.hpp"
#include "shared/las/record_codec.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stipple::las {

namespace {

constexpr std::size_t blockBytes = 1024 * 1024; // packed records written at a time
constexpr std::uint16_t wktBit = 1u << 4;
constexpr std::size_t maxVlrData = 65535;
constexpr std::uint64_t maxLegacyCount = std::numeric_limits<std::uint32_t>::max();

Error invalid(std::string what, std::string advice = "") {
    return {ErrorCode::invalidArgument, std::move(what), "", std::move(advice)};
}

// The type of a LAS attribute, whichever format has it.
const Attribute* lasAttribute(std::string_view name) {
    static const std::array<Schema, 2> all{schemaOf(5), schemaOf(10)};
    for (const Schema& schema : all)
        if (int index = schema.find(name); index >= 0)
            return &schema.attributes[static_cast<std::size_t>(index)];
    return nullptr;
}

// The lowest format that has most (where possible all) of the schema's LAS attributes.
int choosePointFormat(const Schema& schema) {
    int best = 0;
    std::ptrdiff_t mostHeld = -1;
    for (int format = 0; format <= 10; ++format) {
        Schema fields = schemaOf(format);
        auto held = std::count_if(schema.attributes.begin(), schema.attributes.end(),
                                  [&](const Attribute& a) { return fields.find(a.name) >= 0; });
        if (held > mostHeld) {
            best = format;
            mostHeld = held;
        }
    }
    return best;
}

// How the columns of a schema become records.
struct Plan {
    RecordLayout layout;
    std::vector<ColumnField> columns;
    std::vector<std::size_t> described; // schema indices of the extra bytes that get a descriptor
};

Result<Plan> planRecords(const Schema& schema, int pointFormat) {
    Plan plan{baseLayout(pointFormat), {}, {}};
    // The undescribed remainder is recognised only at the end; elsewhere its bytes get a descriptor.
    std::size_t tail = schema.attributes.size();
    while (tail > 0 && isUndescribed(schema.attributes[tail - 1]))
        --tail;
    for (std::size_t a = 0; a < schema.attributes.size(); ++a) {
        const Attribute& attribute = schema.attributes[a];
        const Attribute* field = lasAttribute(attribute.name);
        if (field && (field->type != attribute.type || attribute.components != 1))
            return invalid(cat("LAS stores \"", attribute.name, "\" as one ", attributeTypeName(field->type),
                               ", but it is ", attribute.components, " × ",
                               attributeTypeName(attribute.type)),
                           "give the attribute another name");
        if (auto place = findField(plan.layout, attribute.name)) {
            plan.columns.push_back({a, *place});
            continue;
        }
        plan.columns.push_back({a, {a, plan.layout.recordLength, attribute.size(), 0, 0}});
        plan.layout.recordLength += attribute.size();
        if (a < tail)
            plan.described.push_back(a);
    }
    if (plan.layout.recordLength > std::numeric_limits<std::uint16_t>::max())
        return invalid(
            cat("a point record of ", plan.layout.recordLength, " bytes is longer than LAS allows"));
    if (plan.described.size() * extraBytesDescriptorSize > maxVlrData)
        return invalid(cat(plan.described.size(), " extra attributes are more than the ",
                           maxVlrData / extraBytesDescriptorSize, " that LAS describes"));
    return plan;
}

int chooseVersionMinor(const WriterOptions& options, int pointFormat, const Plan& plan) {
    bool extended = std::any_of(options.vlrs.begin(), options.vlrs.end(),
                                [](const Vlr& vlr) { return vlr.extended || vlr.data.size() > maxVlrData; });
    if (!options.wkt.empty() || !plan.described.empty() || extended ||
        options.expectedPoints > maxLegacyCount)
        return 4;
    int minor = 2;
    while (highestPointFormat(minor) < pointFormat)
        ++minor;
    return minor;
}

Status checkOptions(const WriterOptions& options) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(options.grid.scale[axis] > 0) || !std::isfinite(options.grid.scale[axis]) ||
            !std::isfinite(options.grid.offset[axis]))
            return invalid(cat("the ", "xyz"[axis], " scale ", options.grid.scale[axis], " and offset ",
                               options.grid.offset[axis], " make no grid"));
    if (options.pointFormat < -1 || options.pointFormat > 10)
        return invalid(cat("point format ", options.pointFormat, " is not one of 0 to 10"));
    if (options.versionMinor < -1 || options.versionMinor > 4)
        return invalid(cat("LAS 1.", options.versionMinor, " is not one of 1.0 to 1.4"));
    for (std::size_t a = 0; a < options.schema.attributes.size(); ++a) {
        const Attribute& attribute = options.schema.attributes[a];
        if (attribute.components < 1 || attribute.components > 255)
            return invalid(cat("\"", attribute.name, "\" has ", attribute.components, " components"));
        if (options.schema.find(attribute.name) != static_cast<int>(a))
            return invalid(cat("two attributes are named \"", attribute.name, "\""));
    }
    for (const Vlr& vlr : options.vlrs) {
        if (vlr.is(records::projection, records::wkt) || vlr.is(records::spec, records::extraBytes) ||
            vlr.is(records::laszip, records::laszipRecord))
            return invalid(cat("the record ", vlr.userId, " ", vlr.recordId, " is written by itself"));
        if (vlr.omitted)
            return invalid(cat("the data of the record ", vlr.userId, " ", vlr.recordId, " were not loaded"));
    }
    return {};
}

class FileWriter final : public Writer {
  public:
    Status open(const std::string& path, const WriterOptions& options);

    Status write(const PointBatch& batch) override;
    Status finish() override;
    const Header& header() const override { return header_; }
    const std::vector<std::string>& warnings() const override { return warnings_; }

  private:
    Status placeRecords(const WriterOptions& options);
    void fillHeader(const WriterOptions& options);
    Result<Bytes> descriptors() const;
    Status checkBatch(const PointBatch& batch) const;
    void summarize(const PointBatch& batch);
    void updateBounds();
    Result<Bytes> encodeFront();
    HeaderBlock headerBlock() const;
    static void encodeVlr(ByteWriter& to, const Vlr& vlr, int versionMinor);

    Schema schema_;
    Plan plan_;
    Header header_;
    std::vector<Vlr> normalVlrs_, extendedVlrs_;
    std::vector<ValueRange> ranges_; // parallel to plan_.described
    BoxI box_;
    std::uint64_t evlrOffset_ = 0;
    bool failed_ = false, finished_ = false;
    Bytes block_;
    std::vector<std::string> warnings_;
    std::unique_ptr<OutputFile> file_;
    std::unique_ptr<laz::ChunkWriter> chunks_; // LAZ only
};

Status FileWriter::open(const std::string& path, const WriterOptions& options) {
    STIPPLE_CHECK(checkOptions(options));
    schema_ = options.schema;
    int format = options.pointFormat >= 0 ? options.pointFormat : choosePointFormat(schema_);
    STIPPLE_TRY(plan, planRecords(schema_, format));
    plan_ = std::move(plan);
    ranges_.resize(plan_.described.size());
    header_.pointFormat = format;
    header_.versionMinor =
        options.versionMinor >= 0 ? options.versionMinor : chooseVersionMinor(options, format, plan_);
    if (highestPointFormat(header_.versionMinor) < format)
        return invalid(cat("LAS 1.", header_.versionMinor, " has no point format ", format));
    fillHeader(options);
    STIPPLE_CHECK(placeRecords(options));
    for (std::size_t a : plan_.described)
        if (const std::string& name = schema_.attributes[a].name; descriptorName(name) != name)
            warnings_.push_back(cat("the name \"", name, "\" is cut to \"", descriptorName(name),
                                    "\", the 32 bytes LAS has for it"));
    STIPPLE_TRY(front, encodeFront());
    if (front.size() > std::numeric_limits<std::uint32_t>::max())
        return invalid("the records before the points are larger than LAS allows");
    header_.pointDataOffset = static_cast<std::uint32_t>(front.size());
    STIPPLE_TRY(file, OutputFile::create(path));
    file_ = std::move(file);
    STIPPLE_CHECK(file_->append(front));
    if (!header_.compressed)
        return {};
    STIPPLE_TRY(chunks, laz::ChunkWriter::create(*file_, laz::laszipRecordFor(format, header_.recordLength)));
    chunks_ = std::move(chunks);
    return chunks_->begin();
}

void FileWriter::fillHeader(const WriterOptions& options) {
    header_.recordLength = static_cast<std::uint16_t>(plan_.layout.recordLength);
    header_.compressed = options.compressed;
    header_.fileSourceId = options.fileSourceId;
    header_.globalEncoding = static_cast<std::uint16_t>(options.globalEncoding & ~wktBit);
    if (!options.wkt.empty() && header_.versionMinor >= 4)
        header_.globalEncoding |= wktBit;
    header_.projectId = options.projectId;
    header_.systemIdentifier = options.systemIdentifier;
    header_.generatingSoftware = options.generatingSoftware;
    header_.creationDay = options.creationDay;
    header_.creationYear = options.creationYear;
    header_.headerSize = static_cast<std::uint16_t>(headerBlockSize(header_.versionMinor));
    header_.grid = options.grid;
    updateBounds();
}

Status FileWriter::placeRecords(const WriterOptions& options) {
    auto place = [&](Vlr vlr) -> Status {
        bool extended = vlr.data.size() > maxVlrData || (vlr.extended && header_.versionMinor >= 4);
        if (extended && header_.versionMinor < 4)
            return invalid(cat("the record ", vlr.userId, " ", vlr.recordId, " of ", vlr.data.size(),
                               " bytes needs LAS 1.4"));
        vlr.extended = extended;
        (extended ? extendedVlrs_ : normalVlrs_).push_back(std::move(vlr));
        return {};
    };
    if (!options.wkt.empty()) {
        Vlr wkt{std::string(records::projection), records::wkt, "OGC coordinate system WKT", {}};
        wkt.data.assign(options.wkt.begin(), options.wkt.end());
        wkt.data.push_back(0);
        STIPPLE_CHECK(place(std::move(wkt)));
    }
    for (const Vlr& vlr : options.vlrs)
        STIPPLE_CHECK(place(vlr));
    if (options.compressed)
        STIPPLE_CHECK(
            place({std::string(records::laszip), records::laszipRecord, "how the points are compressed",
                   encodeLaszipRecord(laz::laszipRecordFor(header_.pointFormat, header_.recordLength))}));
    return {};
}

Result<Bytes> FileWriter::descriptors() const {
    Bytes all;
    for (std::size_t i = 0; i < plan_.described.size(); ++i) {
        STIPPLE_TRY(one, encodeDescriptor(schema_.attributes[plan_.described[i]], ranges_[i]));
        all.insert(all.end(), one.begin(), one.end());
    }
    return all;
}

void FileWriter::encodeVlr(ByteWriter& to, const Vlr& vlr, int versionMinor) {
    constexpr std::uint16_t signature10 = 0xAABB; // LAS 1.0 §"Variable length records"
    to.write(versionMinor == 0 ? signature10 : std::uint16_t{0});
    to.writeFixedText(vlr.userId, 16);
    to.write(vlr.recordId);
    if (vlr.extended)
        to.write(static_cast<std::uint64_t>(vlr.data.size()));
    else
        to.write(static_cast<std::uint16_t>(vlr.data.size()));
    to.writeFixedText(vlr.description, 32);
    to.writeBytes(vlr.data);
}

HeaderBlock FileWriter::headerBlock() const {
    HeaderBlock block;
    block.fileSourceId = header_.fileSourceId;
    block.globalEncoding = header_.globalEncoding;
    block.projectId = header_.projectId;
    block.versionMinor = static_cast<std::uint8_t>(header_.versionMinor);
    block.systemIdentifier = header_.systemIdentifier;
    block.generatingSoftware = header_.generatingSoftware;
    block.creationDay = header_.creationDay;
    block.creationYear = header_.creationYear;
    block.headerSize = header_.headerSize;
    block.pointDataOffset = header_.pointDataOffset;
    block.vlrCount = static_cast<std::uint32_t>(normalVlrs_.size() + (plan_.described.empty() ? 0 : 1));
    constexpr int compressedBit = 0x80;
    block.pointFormatByte =
        static_cast<std::uint8_t>(header_.pointFormat | (header_.compressed ? compressedBit : 0));
    block.recordLength = header_.recordLength;
    block.scale = header_.grid.scale;
    block.offset = header_.grid.offset;
    block.bounds = header_.bounds;
    block.evlrOffset = evlrOffset_;
    block.evlrCount = static_cast<std::uint32_t>(extendedVlrs_.size());
    block.pointCount = header_.pointCount;
    block.pointsByReturn = header_.pointsByReturn;
    // Legacy counts are 0 where readers of LAS 1.3 could not read the points anyway (§2.4).
    if (header_.pointFormat < 6 && header_.pointCount <= maxLegacyCount) {
        block.legacyPointCount = static_cast<std::uint32_t>(header_.pointCount);
        for (std::size_t i = 0; i < block.legacyPointsByReturn.size(); ++i)
            block.legacyPointsByReturn[i] = static_cast<std::uint32_t>(header_.pointsByReturn[i]);
    }
    return block;
}

// Everything before the points; of the same size each time.
Result<Bytes> FileWriter::encodeFront() {
    ByteWriter front;
    front.writeBytes(encodeHeaderBlock(headerBlock()));
    for (const Vlr& vlr : normalVlrs_)
        encodeVlr(front, vlr, header_.versionMinor);
    if (!plan_.described.empty()) {
        STIPPLE_TRY(described, descriptors());
        encodeVlr(
            front,
            {std::string(records::spec), records::extraBytes, "Extra Bytes Record", std::move(described)},
            header_.versionMinor);
    }
    if (header_.versionMinor == 0)
        front.write(std::uint16_t{0xCCDD}); // the signature that closes the records of LAS 1.0
    return front.take();
}

Status FileWriter::checkBatch(const PointBatch& batch) const {
    if (failed_ || finished_)
        return invalid("the file is finished, or an earlier write failed");
    if (batch.columns.size() != schema_.attributes.size())
        return invalid(
            cat("the batch has ", batch.columns.size(), " columns, the schema ", schema_.attributes.size()));
    for (std::size_t a = 0; a < batch.columns.size(); ++a)
        if (batch.columns[a].size() != batch.size() * schema_.attributes[a].size())
            return invalid(cat("the column \"", schema_.attributes[a].name, "\" has ",
                               batch.columns[a].size(), " bytes for ", batch.size(), " points"));
    if (header_.versionMinor < 4 && batch.size() > maxLegacyCount - header_.pointCount)
        return Error{ErrorCode::limitExceeded,
                     cat("LAS 1.", header_.versionMinor, " holds at most ", maxLegacyCount, " points"),
                     file_->path(), "write LAS 1.4"};
    return {};
}

Status FileWriter::write(const PointBatch& batch) {
    STIPPLE_CHECK(checkBatch(batch));
    failed_ = true; // until the batch is written whole
    std::size_t stride = plan_.layout.recordLength;
    std::size_t pointsPerBlock = std::max<std::size_t>(1, blockBytes / stride);
    block_.resize(std::min(pointsPerBlock, batch.size()) * stride);
    for (std::size_t done = 0; done < batch.size(); done += pointsPerBlock) {
        std::size_t count = std::min(pointsPerBlock, batch.size() - done);
        Status packed = packRecords(plan_.layout, plan_.columns, schema_, batch, done, count, block_.data());
        if (!packed.ok())
            return packed.error().at(file_->path());
        ByteSpan records(block_.data(), count * stride);
        STIPPLE_CHECK(chunks_ ? chunks_->write(records) : file_->append(records));
    }
    summarize(batch);
    failed_ = false;
    return {};
}

void FileWriter::summarize(const PointBatch& batch) {
    for (Vec3i p : batch.positions)
        box_.extend(p);
    updateBounds();
    header_.pointCount += batch.size();
    if (int a = schema_.find(attribute_names::returnNumber); a >= 0) {
        std::array<std::uint64_t, 256> counts{};
        for (std::uint8_t number : batch.columns[static_cast<std::size_t>(a)])
            ++counts[number];
        std::size_t returns = header_.pointFormat >= 6 ? 15 : 5; // legacy counts have five places
        for (std::size_t i = 0; i < returns; ++i)
            header_.pointsByReturn[i] += counts[i + 1];
    }
    for (std::size_t i = 0; i < ranges_.size(); ++i) {
        std::size_t a = plan_.described[i];
        extendRange(ranges_[i], schema_.attributes[a], batch.columns[a]);
    }
}

void FileWriter::updateBounds() {
    header_.bounds = {};
    if (box_.empty()) {
        header_.bounds.min = header_.bounds.max = {0, 0, 0};
        return;
    }
    header_.bounds.extend(header_.grid.toWorld(box_.min));
    header_.bounds.extend(header_.grid.toWorld(box_.max));
}

Status FileWriter::finish() {
    if (failed_ || finished_)
        return invalid("the file is finished, or a write failed");
    finished_ = true;
    if (chunks_)
        STIPPLE_CHECK(chunks_->finish());
    if (!extendedVlrs_.empty())
        evlrOffset_ = file_->sizeBytes();
    for (const Vlr& vlr : extendedVlrs_) {
        ByteWriter record;
        encodeVlr(record, vlr, header_.versionMinor);
        STIPPLE_CHECK(file_->append(record.bytes()));
    }
    STIPPLE_TRY(front, encodeFront());
    STIPPLE_CHECK(file_->overwrite(0, front));
    return file_->commit();
}

} // namespace

Result<std::unique_ptr<Writer>> Writer::create(const std::string& path, const WriterOptions& options) {
    auto writer = std::make_unique<FileWriter>();
    if (Status opened = writer->open(path, options); !opened.ok())
        return opened.error().where == path ? opened.error() : opened.error().at(path);
    return std::unique_ptr<Writer>(std::move(writer));
}

WriterOptions optionsLike(const Reader& reader) {
    const Header& header = reader.header();
    WriterOptions options;
    options.grid = header.grid;
    options.schema = reader.schema();
    options.pointFormat = header.pointFormat;
    options.versionMinor =
        header.pointFormat <= highestPointFormat(header.versionMinor) ? header.versionMinor : -1;
    options.expectedPoints = reader.pointCount();
    options.compressed = header.compressed;
    options.wkt = wktRecord(header);
    for (const Vlr& vlr : header.vlrs)
        if (!vlr.omitted && !vlr.is(records::projection, records::wkt) &&
            !vlr.is(records::spec, records::extraBytes) && !vlr.is(records::laszip, records::laszipRecord))
            options.vlrs.push_back(vlr);
    options.systemIdentifier = header.systemIdentifier;
    options.generatingSoftware = header.generatingSoftware;
    options.globalEncoding = header.globalEncoding;
    constexpr std::uint16_t packetsAreInternal = 2; // no longer: they stay in the file that was read
    options.globalEncoding &= static_cast<std::uint16_t>(~packetsAreInternal);
    options.fileSourceId = header.fileSourceId;
    options.projectId = header.projectId;
    options.creationDay = header.creationDay;
    options.creationYear = header.creationYear;
    return options;
}

} // namespace stipple::las
