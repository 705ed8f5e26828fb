#include "shared/las/las_writer.hpp"

#include "shared/base/text.hpp"
#include "shared/las/extra_bytes.hpp"
#include "shared/las/file_shape.hpp"
#include "shared/las/header_block.hpp"
#include "shared/las/las_records.hpp"
#include "shared/las/laz/chunk_writer.hpp"
#include "shared/las/record_codec.hpp"

#include <algorithm>
#include <limits>

namespace stipple::las {

namespace {

constexpr std::size_t blockBytes = 1024 * 1024; // packed records written at a time
constexpr std::uint16_t wktBit = 1u << 4;

Error invalid(std::string what, std::string advice = "") {
    return {ErrorCode::invalidArgument, std::move(what), "", std::move(advice)};
}

class FileWriter final : public Writer {
  public:
    Status open(std::unique_ptr<ByteSink> to, const WriterOptions& options,
                std::optional<PointSummary> stated);

    Status write(const PointBatch& batch) override;
    Status finish() override;
    const Header& header() const override { return header_; }
    const std::vector<std::string>& warnings() const override { return warnings_; }

  private:
    Status placeRecords(const WriterOptions& options);
    void fillHeader(const WriterOptions& options);
    Result<Bytes> descriptors(const PointSummary& summary) const;
    Status checkBatch(const PointBatch& batch) const;
    Error tooManyPoints() const;
    Status writeEvlrs();
    Status state(const PointSummary& summary);
    void putIntoHeader(const PointSummary& summary);
    Result<Bytes> encodeFront(const PointSummary& summary);
    HeaderBlock headerBlock() const;
    static void encodeVlr(ByteWriter& to, const Vlr& vlr, int versionMinor);

    Schema schema_;
    RecordPlan plan_;
    Header header_;
    std::vector<Vlr> normalVlrs_, extendedVlrs_;
    SummaryColumns columns_;
    PointSummary summary_;               // of the points written
    std::optional<PointSummary> stated_; // of all
    std::uint64_t evlrOffset_ = 0;
    bool failed_ = false, finished_ = false;
    Bytes block_;
    std::vector<std::string> warnings_;
    std::unique_ptr<ByteSink> to_;
    std::unique_ptr<laz::ChunkWriter> chunks_; // LAZ only
};

Status FileWriter::open(std::unique_ptr<ByteSink> to, const WriterOptions& options,
                        std::optional<PointSummary> stated) {
    to_ = std::move(to);
    stated_ = std::move(stated);
    if (!to_->canOverwrite() && options.compressed)
        return invalid(
            "the place of a LAZ file's chunk table stands before the chunks, so it is written last",
            "write to a file first, or LAS");
    if (!to_->canOverwrite() && !stated_)
        return invalid("the header of a LAS file tells what its points are, and comes before them",
                       "summarize the points first, or write to a file");
    STIPPLE_TRY(shape, shapeOf(options));
    schema_ = options.schema;
    plan_ = std::move(shape.plan);
    columns_ = summaryColumns(plan_, schema_, shape.pointFormat);
    summary_.ranges.resize(plan_.described.size());
    header_.pointFormat = shape.pointFormat;
    header_.versionMinor = shape.versionMinor;
    fillHeader(options);
    STIPPLE_CHECK(placeRecords(options));
    for (std::size_t a : plan_.described)
        if (const std::string& name = schema_.attributes[a].name; descriptorName(name) != name)
            warnings_.push_back(cat("the name \"", name, "\" is cut to \"", descriptorName(name),
                                    "\", the 32 bytes LAS has for it"));
    STIPPLE_TRY(unknown, encodeFront(summary_));
    if (unknown.size() > std::numeric_limits<std::uint32_t>::max())
        return invalid("the records before the points are larger than LAS allows");
    header_.pointDataOffset = static_cast<std::uint32_t>(unknown.size());
    if (stated_)
        STIPPLE_CHECK(state(*stated_));
    STIPPLE_TRY(front, encodeFront(stated_.value_or(summary_)));
    STIPPLE_CHECK(to_->append(front));
    if (!header_.compressed)
        return {};
    STIPPLE_TRY(chunks, laz::ChunkWriter::create(
                            *to_, laz::laszipRecordFor(header_.pointFormat, header_.recordLength),
                            options.makeChunkWork ? options.makeChunkWork() : nullptr));
    chunks_ = std::move(chunks);
    return chunks_->begin();
}

// What the header says has to be true at the end.
Status FileWriter::state(const PointSummary& summary) {
    if (summary.ranges.size() != plan_.described.size())
        return invalid(cat("the summary has ranges of ", summary.ranges.size(),
                           " extra attributes instead of ", plan_.described.size()));
    if (header_.versionMinor < 4 && summary.pointCount > maxLegacyCount)
        return tooManyPoints();
    if (!extendedVlrs_.empty() && !header_.compressed)
        evlrOffset_ = header_.pointDataOffset + summary.pointCount * header_.recordLength;
    return {};
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
    putIntoHeader(summary_);
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

Result<Bytes> FileWriter::descriptors(const PointSummary& summary) const {
    Bytes all;
    for (std::size_t i = 0; i < plan_.described.size(); ++i) {
        STIPPLE_TRY(one, encodeDescriptor(schema_.attributes[plan_.described[i]], summary.ranges[i]));
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
Result<Bytes> FileWriter::encodeFront(const PointSummary& summary) {
    putIntoHeader(summary);
    ByteWriter front;
    front.writeBytes(encodeHeaderBlock(headerBlock()));
    for (const Vlr& vlr : normalVlrs_)
        encodeVlr(front, vlr, header_.versionMinor);
    if (!plan_.described.empty()) {
        STIPPLE_TRY(described, descriptors(summary));
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
    if (header_.versionMinor < 4 && batch.size() > maxLegacyCount - summary_.pointCount)
        return tooManyPoints();
    return {};
}

Error FileWriter::tooManyPoints() const {
    return {ErrorCode::limitExceeded,
            cat("LAS 1.", header_.versionMinor, " holds at most ", maxLegacyCount, " points"), to_->name(),
            "write LAS 1.4"};
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
            return packed.error().at(to_->name());
        ByteSpan records(block_.data(), count * stride);
        STIPPLE_CHECK(chunks_ ? chunks_->write(records) : to_->append(records));
    }
    addToSummary(summary_, columns_, schema_, batch);
    putIntoHeader(summary_);
    failed_ = false;
    return {};
}

void FileWriter::putIntoHeader(const PointSummary& summary) {
    header_.pointCount = summary.pointCount;
    header_.pointsByReturn = summary.pointsByReturn;
    header_.bounds = {};
    if (summary.bounds.empty()) {
        header_.bounds.min = header_.bounds.max = {0, 0, 0};
        return;
    }
    header_.bounds.extend(header_.grid.toWorld(summary.bounds.min));
    header_.bounds.extend(header_.grid.toWorld(summary.bounds.max));
}

Status FileWriter::writeEvlrs() {
    if (!extendedVlrs_.empty())
        evlrOffset_ = to_->sizeBytes();
    for (const Vlr& vlr : extendedVlrs_) {
        ByteWriter record;
        encodeVlr(record, vlr, header_.versionMinor);
        STIPPLE_CHECK(to_->append(record.bytes()));
    }
    return {};
}

Status FileWriter::finish() {
    if (failed_ || finished_)
        return invalid("the file is finished, or a write failed");
    finished_ = true;
    if (chunks_)
        STIPPLE_CHECK(chunks_->finish());
    STIPPLE_CHECK(writeEvlrs());
    if (stated_ && summary_ != *stated_ && !to_->canOverwrite())
        return Error{ErrorCode::corrupt,
                     cat("other points came than were stated (", summary_.pointCount, " instead of ",
                         stated_->pointCount, ")"),
                     to_->name(), "the cloud contradicts itself; convert the scan again"};
    if (to_->canOverwrite()) {
        STIPPLE_TRY(front, encodeFront(summary_));
        STIPPLE_CHECK(to_->overwrite(0, front));
    }
    return to_->finish();
}

} // namespace

Result<SummaryColumns> summaryColumnsFor(const WriterOptions& options) {
    STIPPLE_TRY(shape, shapeOf(options));
    return summaryColumns(shape.plan, options.schema, shape.pointFormat);
}

Result<std::unique_ptr<Writer>> Writer::create(const std::string& path, const WriterOptions& options) {
    // Before a file is made that would have to go again.
    if (auto shape = shapeOf(options); !shape)
        return shape.error().at(path);
    STIPPLE_TRY(file, fileSink(path));
    return create(std::move(file), options);
}

Result<std::unique_ptr<Writer>> Writer::create(std::unique_ptr<ByteSink> to, const WriterOptions& options,
                                               std::optional<PointSummary> stated) {
    std::string name = to->name();
    auto writer = std::make_unique<FileWriter>();
    Status opened = writer->open(std::move(to), options, std::move(stated));
    if (!opened.ok())
        return name.empty() || opened.error().where == name ? opened.error() : opened.error().at(name);
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
