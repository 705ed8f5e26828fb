#include "shared/las/las_reader.hpp"

#include "shared/base/text.hpp"
#include "shared/las/extra_bytes.hpp"
#include "shared/las/header_block.hpp"
#include "shared/las/las_records.hpp"
#include "shared/las/laz/chunk_reader.hpp"
#include "shared/las/laz/layer_choice.hpp"
#include "shared/las/record_codec.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stipple::las {

namespace {

// What one read asks of the source: enough for a disk or a server, little beside a batch.
constexpr std::uint64_t readBytes = 2 * 1024 * 1024;

// Decoded records at a time.
constexpr std::uint64_t blockBytes = 16 * 1024;
// The room that is made for points before any of them is decoded.
constexpr std::uint64_t trustedBytes = 64 * 1024 * 1024;

constexpr std::uint8_t compressedBits = 0xC0; // LAZ: bit 7; old LASzip: bit 6

class FileReader final : public Reader {
  public:
    explicit FileReader(ByteSource& source) : source_(source) {}
    // Another reader of a file that was parsed.
    FileReader(const FileReader& parsed, ByteSource& source)
        : source_(source), header_(parsed.header_), layout_(parsed.layout_), pointCount_(parsed.pointCount_),
          pointsEnd_(parsed.pointsEnd_), warnings_(parsed.warnings_), fileBytes_(parsed.fileBytes_),
          chunkIndex_(parsed.chunkIndex_) {
        makeChunkReader();
    }

    Status parse();
    Result<std::unique_ptr<Reader>> openAnother(ByteSource& source) const override;

    const Header& header() const override { return header_; }
    const Schema& schema() const override { return layout_.schema; }
    std::uint64_t pointCount() const override { return pointCount_; }
    const std::vector<std::string>& warnings() const override { return warnings_; }
    std::span<const std::uint64_t> chunkStarts() const override;
    void select(std::span<const std::string> attributes) override;
    Status read(std::uint64_t first, std::uint64_t count, PointBatch& batch) override;

  private:
    template <class... Parts>
    void warn(const Parts&... parts) {
        warnings_.push_back(cat(parts...));
    }
    Error corrupt(std::string what, std::uint64_t atByte) const {
        return {ErrorCode::corrupt, std::move(what), cat("byte ", atByte), ""};
    }
    void takeFields(const HeaderBlock& block);
    Status takeGrid(const HeaderBlock& block);
    Status takeFormat(const HeaderBlock& block);
    void takeCounts(const HeaderBlock& block);
    Status readRecords(const HeaderBlock& block, WindowReader& file);
    Status placePoints(const HeaderBlock& block, WindowReader& file, std::uint64_t recordsEnd);
    Result<bool> signatureAt(WindowReader& file, std::uint64_t offset) const;
    Status readExtendedRecords(const HeaderBlock& block, WindowReader& file, RecordWalk& walk);
    void buildLayout();
    Status countPoints();
    void makeChunkReader();
    Status readRecords(std::uint64_t first, std::uint64_t count, PointBatch& batch);
    Status readChunks(std::uint64_t first, std::uint64_t count, PointBatch& batch);

    ByteSource& source_;
    Header header_;
    RecordLayout layout_;
    std::uint64_t pointCount_ = 0;
    std::uint64_t pointsEnd_ = 0; // end of the file, or where the extended records begin
    std::vector<std::string> warnings_;
    std::uint64_t fileBytes_ = 0;
    // LAZ only:
    std::shared_ptr<const laz::ChunkIndex> chunkIndex_;
    std::unique_ptr<laz::ChunkReader> chunks_;
    Bytes block_; // records that were decoded, on their way into columns
};

Status FileReader::parse() {
    auto front = readNow(source_, {0, maxHeaderBlockSize});
    // An empty file answers `truncated`; the header says it better.
    if (!front.ok() && front.error().code != ErrorCode::truncated)
        return front.error();
    STIPPLE_TRY(block, decodeHeaderBlock(front.ok() ? ByteSpan(*front) : ByteSpan{}));
    takeFields(block);
    STIPPLE_CHECK(takeGrid(block));
    STIPPLE_CHECK(takeFormat(block));
    takeCounts(block);
    WindowReader file(source_, source_.sizeBytes());
    pointsEnd_ = fileBytes_ = file.fileBytes();
    STIPPLE_CHECK(readRecords(block, file));
    buildLayout();
    return countPoints();
}

Result<std::unique_ptr<Reader>> FileReader::openAnother(ByteSource& source) const {
    // The size of a source is known after its first answer.
    if (source.sizeBytes() == 0)
        STIPPLE_CHECK(readNow(source, {0, 1}));
    if (source.sizeBytes() != fileBytes_)
        return Error{ErrorCode::changed,
                     cat("the file has ", source.sizeBytes(), " bytes now, but had ", fileBytes_),
                     source.name(), "open it again"};
    return std::unique_ptr<Reader>(std::make_unique<FileReader>(*this, source));
}

void FileReader::makeChunkReader() {
    if (chunkIndex_)
        chunks_ = std::make_unique<laz::ChunkReader>(source_, chunkIndex_);
}

std::span<const std::uint64_t> FileReader::chunkStarts() const {
    if (!chunkIndex_ || chunkIndex_->starts.empty())
        return {};
    // The last entry closes the last chunk; an empty file has one entry.
    const std::span<const std::uint64_t> all = chunkIndex_->starts;
    return all.size() == 1 ? all : all.first(all.size() - 1);
}

void FileReader::select(std::span<const std::string> attributes) {
    if (chunks_)
        chunks_->select(laz::layersOf(layout_, attributes));
}

void FileReader::takeFields(const HeaderBlock& block) {
    header_.versionMajor = block.versionMajor;
    header_.versionMinor = block.versionMinor;
    header_.fileSourceId = block.fileSourceId;
    header_.globalEncoding = block.globalEncoding;
    header_.projectId = block.projectId;
    header_.systemIdentifier = block.systemIdentifier;
    header_.generatingSoftware = block.generatingSoftware;
    header_.creationDay = block.creationDay;
    header_.creationYear = block.creationYear;
    header_.headerSize = block.headerSize;
    header_.bounds = block.bounds;
    header_.waveformOffset = block.waveformOffset;
    if (block.headerSize < headerBlockSize(block.versionMinor))
        warn("header byte 94: a header of ", block.headerSize, " bytes is too short for LAS 1.",
             block.versionMinor, "; what it leaves out is taken as 0");
}

Status FileReader::takeGrid(const HeaderBlock& block) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!(block.scale[axis] > 0) || !std::isfinite(block.scale[axis]))
            return corrupt(
                cat("the ", "xyz"[axis], " scale factor is ", block.scale[axis], ", not a positive number"),
                131 + 8 * static_cast<std::uint64_t>(axis));
        if (!std::isfinite(block.offset[axis]))
            return corrupt(cat("the ", "xyz"[axis], " offset is ", block.offset[axis]),
                           155 + 8 * static_cast<std::uint64_t>(axis));
    }
    header_.grid = {block.scale, block.offset};
    return {};
}

Status FileReader::takeFormat(const HeaderBlock& block) {
    header_.compressed = (block.pointFormatByte & compressedBits) != 0;
    header_.pointFormat = block.pointFormatByte & ~compressedBits;
    if (header_.pointFormat > 10)
        return Error{ErrorCode::unsupported, cat("point format ", header_.pointFormat, " is not known"),
                     "header byte 104", "formats 0 to 10 are read"};
    if (header_.pointFormat > highestPointFormat(block.versionMinor))
        warn("header byte 104: point format ", header_.pointFormat, " is not part of LAS 1.",
             block.versionMinor, "; it is read as later versions define it");
    header_.recordLength = block.recordLength;
    std::size_t needed = pointRecordSize(header_.pointFormat);
    if (block.recordLength < needed)
        return corrupt(cat("point records of format ", header_.pointFormat, " need ", needed,
                           " bytes, but the header gives them ", block.recordLength),
                       105);
    return {};
}

void FileReader::takeCounts(const HeaderBlock& block) {
    header_.pointCount = block.legacyPointCount;
    std::copy(block.legacyPointsByReturn.begin(), block.legacyPointsByReturn.end(),
              header_.pointsByReturn.begin());
    if (!block.hasLongCounts())
        return;
    if (block.pointCount == 0 && block.legacyPointCount != 0) {
        warn("header byte 247: the 64-bit point count is 0; the legacy count ", block.legacyPointCount,
             " holds");
        return;
    }
    if (block.legacyPointCount != 0 && block.legacyPointCount != block.pointCount)
        warn("header byte 107: the legacy point count is ", block.legacyPointCount, "; the 64-bit count of ",
             block.pointCount, " holds");
    header_.pointCount = block.pointCount;
    header_.pointsByReturn = block.pointsByReturn;
}

Status FileReader::readRecords(const HeaderBlock& block, WindowReader& file) {
    // A bogus point data offset (before the end of the header) can't bound the records.
    bool bogusOffset = block.pointDataOffset < block.headerSize;
    std::uint64_t end = bogusOffset ? file.fileBytes() : block.pointDataOffset;
    RecordWalk walk{header_.vlrs, warnings_};
    STIPPLE_TRY(recordsEnd, readVlrs(file, block.headerSize, block.vlrCount, end, false, walk));
    for (const Vlr& vlr : header_.vlrs)
        header_.compressed = header_.compressed || vlr.is(records::laszip, records::laszipRecord);
    STIPPLE_CHECK(placePoints(block, file, recordsEnd));
    return readExtendedRecords(block, file, walk);
}

// LAS 1.0 closes the records with the bytes DD CC; some writers turned them round.
Result<bool> FileReader::signatureAt(WindowReader& file, std::uint64_t offset) const {
    if (header_.versionMinor != 0 || offset > file.fileBytes() || file.fileBytes() - offset < 2)
        return false;
    STIPPLE_TRY(bytes, file.at(offset, 2));
    return (bytes[0] == 0xDD && bytes[1] == 0xCC) || (bytes[0] == 0xCC && bytes[1] == 0xDD);
}

Status FileReader::placePoints(const HeaderBlock& block, WindowReader& file, std::uint64_t recordsEnd) {
    header_.pointDataOffset = block.pointDataOffset;
    if (header_.compressed)
        return {};
    std::uint64_t offset = block.pointDataOffset;
    bool bogusOffset = offset < block.headerSize;
    if (bogusOffset)
        offset = recordsEnd;
    STIPPLE_TRY(signed_, signatureAt(file, offset));
    // The first point's X may look like the signature: it is one only if a point's worth is not missing.
    std::uint64_t pointBytes = header_.pointCount > std::numeric_limits<std::uint64_t>::max() / 65536
                                   ? std::numeric_limits<std::uint64_t>::max()
                                   : header_.pointCount * header_.recordLength;
    std::uint64_t room = file.fileBytes() - std::min(file.fileBytes(), offset);
    if (signed_ && pointBytes != room) {
        offset += 2;
        room -= 2;
        if (!bogusOffset)
            warn("header byte 96: the point data offset ", block.pointDataOffset,
                 " is that of the LAS 1.0 signature; the points begin at ", offset);
    }
    if (!bogusOffset && room == 0 && header_.pointCount > 0)
        return Error{ErrorCode::truncated,
                     cat("the file ends after ", file.fileBytes(), " bytes, before its points begin"),
                     cat("byte ", offset), "the file was cut off; copy it again"};
    if (bogusOffset) {
        if (pointBytes > room || offset > std::numeric_limits<std::uint32_t>::max())
            return corrupt(cat("the point data offset ", block.pointDataOffset,
                               " lies inside the header, and the points do not follow the records either"),
                           96);
        warn("header byte 96: the point data offset ", block.pointDataOffset,
             " lies inside the header; the points are read after the records, from byte ", offset);
    }
    header_.pointDataOffset = static_cast<std::uint32_t>(offset);
    return {};
}

Status FileReader::readExtendedRecords(const HeaderBlock& block, WindowReader& file, RecordWalk& walk) {
    constexpr std::uint64_t noEnd = std::numeric_limits<std::uint64_t>::max();
    if (block.evlrCount > 0) {
        STIPPLE_TRY(end, readVlrs(file, block.evlrOffset, block.evlrCount, noEnd, true, walk));
        // Records that fill the rest of the file to the byte are where they should be.
        if (end == file.fileBytes() && block.evlrOffset >= header_.pointDataOffset)
            pointsEnd_ = block.evlrOffset;
    }
    // LAS 1.3 has one extended record, the waveform packets, and no count of them. Where the packets are
    // in a file of their own, the offset means nothing here.
    constexpr std::uint16_t packetsAreExternal = 4;
    if (block.waveformOffset == 0 || (block.globalEncoding & packetsAreExternal) != 0)
        return {};
    for (const Vlr& vlr : header_.vlrs)
        if (vlr.extended && vlr.offsetBytes == block.waveformOffset + evlrHeaderSize)
            return {};
    auto packets = readVlrs(file, block.waveformOffset, 1, noEnd, true, walk);
    STIPPLE_CHECK(packets);
    return {};
}

void FileReader::buildLayout() {
    layout_ = baseLayout(header_.pointFormat);
    Bytes descriptors;
    for (const Vlr& vlr : header_.vlrs)
        if (vlr.is(records::spec, records::extraBytes))
            descriptors.insert(descriptors.end(), vlr.data.begin(), vlr.data.end());
    addExtraBytes(layout_, header_.recordLength, descriptors, warnings_);
}

Status FileReader::countPoints() {
    pointCount_ = header_.pointCount;
    if (header_.compressed) {
        STIPPLE_TRY(index, laz::readChunkIndex(source_, header_, pointsEnd_, warnings_));
        pointCount_ = index.pointCount;
        chunkIndex_ = std::make_shared<const laz::ChunkIndex>(std::move(index));
        makeChunkReader();
        return {};
    }
    std::uint64_t room = pointsEnd_ - std::min<std::uint64_t>(pointsEnd_, header_.pointDataOffset);
    if (pointCount_ > room / header_.recordLength) {
        pointCount_ = room / header_.recordLength;
        warn("the header counts ", header_.pointCount, " points, but ",
             pointsEnd_ == fileBytes_ ? "the file ends" : "the extended records begin", " after ",
             pointCount_);
    }
    return {};
}

Status FileReader::read(std::uint64_t first, std::uint64_t count, PointBatch& batch) {
    if (first > pointCount_)
        return Error{ErrorCode::outOfRange,
                     cat("point ", first, " was asked for, but there are only ", pointCount_), source_.name(),
                     ""};
    count = std::min(count, pointCount_ - first);
    if (!chunks_)
        return readRecords(first, count, batch);
    Status decoded = readChunks(first, count, batch);
    if (decoded.ok())
        return {};
    batch.resize(layout_.schema, 0);
    return decoded.error().at(source_.name());
}

Status FileReader::readRecords(std::uint64_t first, std::uint64_t count, PointBatch& batch) {
    batch.resize(layout_.schema, static_cast<std::size_t>(count));
    std::uint64_t recordsPerRead = std::max<std::uint64_t>(1, readBytes / layout_.recordLength);
    for (std::uint64_t done = 0; done < count; done += recordsPerRead) {
        std::uint64_t part = std::min(recordsPerRead, count - done);
        ByteRange range{header_.pointDataOffset + (first + done) * layout_.recordLength,
                        part * layout_.recordLength};
        STIPPLE_TRY(bytes, readNow(source_, range));
        if (bytes.size() != range.size)
            return Error{ErrorCode::changed, "the file became shorter while it was read",
                         cat(source_.name(), ", byte ", range.offset), "open it again"};
        unpackRecords(layout_, bytes, batch, static_cast<std::size_t>(done));
    }
    return {};
}

// In blocks that stay in the cache from decoding to the columns.
Status FileReader::readChunks(std::uint64_t first, std::uint64_t count, PointBatch& batch) {
    STIPPLE_CHECK(chunks_->seek(first));
    const std::uint64_t recordsPerBlock = std::max<std::uint64_t>(1, blockBytes / layout_.recordLength);
    std::uint64_t room = std::max(recordsPerBlock, trustedBytes / layout_.recordLength) / 2;
    for (std::uint64_t done = 0; done < count; done += recordsPerBlock) {
        std::uint64_t part = std::min(recordsPerBlock, count - done);
        // A header may count any number of points: the batch grows as they turn out to be there.
        if (done == 0 || done + part > room) {
            room = std::min(count, 2 * room);
            batch.resize(layout_.schema, static_cast<std::size_t>(room));
        }
        block_.resize(static_cast<std::size_t>(part) * layout_.recordLength);
        STIPPLE_CHECK(chunks_->read(block_));
        unpackRecords(layout_, block_, batch, static_cast<std::size_t>(done));
    }
    batch.resize(layout_.schema, static_cast<std::size_t>(count));
    return {};
}

} // namespace

Result<std::unique_ptr<Reader>> Reader::open(ByteSource& source) {
    auto reader = std::make_unique<FileReader>(source);
    if (Status parsed = reader->parse(); !parsed.ok())
        return parsed.error().at(source.name());
    return std::unique_ptr<Reader>(std::move(reader));
}

Schema schemaOf(int pointFormat) {
    return baseLayout(pointFormat).schema;
}

} // namespace stipple::las
