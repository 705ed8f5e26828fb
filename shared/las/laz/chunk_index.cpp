#include "shared/las/laz/chunk_index.hpp"

#include "shared/base/text.hpp"
#include "shared/las/laz/arithmetic_decoder.hpp"
#include "shared/las/laz/chunk_table.hpp"

#include <algorithm>

namespace stipple::las::laz {

namespace {

// More than any encoder can put into a byte: a symbol costs some ten-thousandths of a bit however often it
// repeats, and a point of one value takes ten of them (10^7 equal points: 660 in a byte). What claims more is
// damaged, or made to keep its readers busy.
constexpr std::uint64_t mostPointsPerByte = 2000;

class IndexBuilder {
  public:
    IndexBuilder(ByteSource& source, const Header& header, std::uint64_t pointsEnd,
                 std::vector<std::string>& warnings)
        : source_(source), header_(header), fileBytes_(source.sizeBytes()), pointsEnd_(pointsEnd),
          warnings_(warnings) {}

    Result<ChunkIndex> build();

  private:
    Status parseRecord();
    Status indexChunks();
    Result<std::vector<Chunk>> readTable();
    Result<std::uint64_t> tableOffset();
    Status useTable(const std::vector<Chunk>& chunks);
    Status hopChunks();
    Status takeWhole(std::uint64_t begin);
    Result<Bytes> bytesAt(std::uint64_t offset, std::uint64_t size);
    void addChunk(std::uint64_t points, std::uint64_t bytes);
    std::size_t layerCount() const;

    // The least that a chunk takes.
    std::uint64_t leastChunkBytes() const { return index_.recordLength + ArithmeticDecoder::startBytes; }

    ByteSource& source_;
    const Header& header_;
    std::uint64_t fileBytes_;
    std::uint64_t pointsEnd_; // where the table begins, once that is known
    std::vector<std::string>& warnings_;
    std::uint64_t chunksBegin_ = 0;
    ChunkIndex index_;
};

Result<Bytes> IndexBuilder::bytesAt(std::uint64_t offset, std::uint64_t size) {
    if (offset > fileBytes_ || fileBytes_ - offset < size)
        return Error{ErrorCode::truncated, cat("the file ends after ", fileBytes_, " bytes"),
                     cat("byte ", offset), "the file was cut off; copy it again"};
    return readNow(source_, {offset, size});
}

Status IndexBuilder::parseRecord() {
    for (const Vlr& vlr : header_.vlrs)
        if (vlr.is(records::laszip, records::laszipRecord)) {
            auto record = parseLaszipRecord(vlr.data, header_.pointFormat, header_.recordLength);
            if (!record.ok())
                return record.error().at(cat("byte ", vlr.offsetBytes));
            index_.record = std::move(*record);
            return {};
        }
    return Error{ErrorCode::corrupt,
                 "the point format says that the points are compressed, but no record says how",
                 "header byte 104", "the \"laszip encoded\" record is missing; compress the file again"};
}

Result<ChunkIndex> IndexBuilder::build() {
    index_.recordLength = header_.recordLength;
    STIPPLE_CHECK(parseRecord());
    index_.pointCount = header_.pointCount;
    index_.starts = {0};
    index_.offsets = {header_.pointDataOffset};
    if (index_.pointCount == 0)
        return std::move(index_);
    if (header_.pointDataOffset >= pointsEnd_)
        return Error{ErrorCode::truncated,
                     cat("the points begin at byte ", header_.pointDataOffset, ", but the file ends after ",
                         pointsEnd_),
                     "header byte 96", "the file was cut off; copy it again"};
    if (index_.record.isChunked())
        STIPPLE_CHECK(indexChunks());
    else
        STIPPLE_CHECK(takeWhole(header_.pointDataOffset));
    return std::move(index_);
}

Status IndexBuilder::takeWhole(std::uint64_t begin) {
    const std::uint64_t bytes = pointsEnd_ - std::min(pointsEnd_, begin);
    if (index_.pointCount / mostPointsPerByte > bytes)
        return Error{
            ErrorCode::corrupt,
            cat("the header counts ", index_.pointCount, " points, more than ", bytes, " bytes can hold"),
            "header byte 107", "the file is damaged; copy it again"};
    index_.starts = {0, index_.pointCount};
    index_.offsets = {begin, pointsEnd_};
    return {};
}

Status IndexBuilder::indexChunks() {
    chunksBegin_ = header_.pointDataOffset + sizeof(std::uint64_t);
    index_.offsets = {chunksBegin_};
    auto table = readTable();
    Status used = table.ok() ? useTable(*table) : Status(table.error());
    if (used.ok())
        return {};
    if (used.error().code == ErrorCode::ioFailed || used.error().code == ErrorCode::networkFailed ||
        used.error().code == ErrorCode::changed)
        return used;
    index_.starts = {0};
    index_.offsets = {chunksBegin_};
    if (index_.record.compressor == Compressor::layeredChunked) {
        STIPPLE_CHECK(hopChunks());
    } else if (!index_.record.hasVariableChunks()) {
        STIPPLE_CHECK(takeWhole(chunksBegin_));
        index_.sequential = true;
    } else {
        return Error{
            ErrorCode::corrupt,
            cat(used.error().what, "; without it, chunks of any number of points can't be told apart"),
            used.error().where, "compress the file again"};
    }
    warnings_.push_back(cat(used.error().where, ": ", used.error().what, "; the points are read without it",
                            index_.sequential ? ", from the first to the last" : ""));
    return {};
}

// The offset before the chunks, or, where that was not known yet when they were written, at the end of the
// file.
Result<std::uint64_t> IndexBuilder::tableOffset() {
    STIPPLE_TRY(atFront, bytesAt(header_.pointDataOffset, sizeof(std::uint64_t)));
    auto offset = loadLe<std::uint64_t>(atFront.data());
    std::uint64_t where = header_.pointDataOffset;
    if (offset == ~0ull) {
        where = fileBytes_ - sizeof(std::uint64_t);
        STIPPLE_TRY(atEnd, bytesAt(where, sizeof(std::uint64_t)));
        offset = loadLe<std::uint64_t>(atEnd.data());
    }
    if (offset <= chunksBegin_ || offset > fileBytes_ - chunkTableHeadSize)
        return Error{ErrorCode::corrupt,
                     cat("the chunk table should be at byte ", offset, " of ", fileBytes_, ", but can't be"),
                     cat("byte ", where), ""};
    return offset;
}

Result<std::vector<Chunk>> IndexBuilder::readTable() {
    STIPPLE_TRY(offset, tableOffset());
    const std::uint64_t mostChunks = (offset - chunksBegin_) / leastChunkBytes();
    STIPPLE_TRY(head, bytesAt(offset, chunkTableHeadSize));
    std::uint64_t count = std::min<std::uint64_t>(loadLe<std::uint32_t>(head.data() + 4), mostChunks);
    constexpr std::uint64_t mostBytesEach = 16;
    std::uint64_t size = std::min(fileBytes_ - offset, chunkTableHeadSize + (count + 1) * mostBytesEach);
    STIPPLE_TRY(bytes, bytesAt(offset, size));
    auto chunks = parseChunkTable(bytes, index_.record.hasVariableChunks(), mostChunks);
    if (!chunks.ok())
        return chunks.error().at(cat("byte ", offset));
    pointsEnd_ = std::min(pointsEnd_, offset);
    return chunks;
}

void IndexBuilder::addChunk(std::uint64_t points, std::uint64_t bytes) {
    index_.starts.push_back(index_.starts.back() + points);
    index_.offsets.push_back(index_.offsets.back() + bytes);
}

// Takes the table if its chunks fill the place between the points' beginning and the table.
Status IndexBuilder::useTable(const std::vector<Chunk>& chunks) {
    auto damaged = [&](std::string what) {
        return Error{ErrorCode::corrupt, cat("the chunk table ", std::move(what)), cat("byte ", pointsEnd_),
                     ""};
    };
    const bool variable = index_.record.hasVariableChunks();
    std::uint64_t left = pointsEnd_ - chunksBegin_;
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        const Chunk& chunk = chunks[i];
        if (chunk.bytes > left)
            return damaged(cat("gives chunk ", i, " ", chunk.bytes, " bytes, but only ", left, " are left"));
        left -= chunk.bytes;
        const std::uint64_t points = variable ? chunk.points : index_.record.chunkSize;
        if (points == 0 && chunk.bytes == 0)
            continue;
        if (points == 0 || chunk.bytes < leastChunkBytes())
            return damaged(cat("gives chunk ", i, " ", points, " points in ", chunk.bytes, " bytes"));
        const std::uint64_t wanted = std::min(points, index_.pointCount - index_.starts.back());
        if (wanted / mostPointsPerByte > chunk.bytes)
            return damaged(cat("gives chunk ", i, " ", wanted, " points in only ", chunk.bytes, " bytes"));
        if (wanted > 0)
            addChunk(wanted, chunk.bytes);
    }
    const std::uint64_t listed = index_.starts.back();
    if (listed < index_.pointCount) {
        if (left > 0)
            return damaged(cat("lists ", chunks.size(), " chunks for ", index_.pointCount, " points, and ",
                               left, " bytes are in none"));
        warnings_.push_back(
            cat("the header counts ", index_.pointCount, " points, but the chunk table has only ", listed));
        index_.pointCount = listed;
    }
    return {};
}

std::size_t IndexBuilder::layerCount() const {
    std::size_t count = 0;
    for (const Item& item : index_.record.items)
        count += item.type == ItemType::point14    ? 9
                 : item.type == ItemType::rgbNir14 ? 2
                 : item.type == ItemType::byte14   ? item.sizeBytes
                                                   : 1;
    return count;
}

// Layered chunks say after their first record how many points they have and how many bytes each layer.
Status IndexBuilder::hopChunks() {
    const std::size_t headSize = index_.recordLength + 4 + 4 * layerCount();
    while (index_.starts.back() < index_.pointCount) {
        std::uint64_t at = index_.offsets.back();
        if (at >= pointsEnd_ || pointsEnd_ - at < headSize)
            break;
        STIPPLE_TRY(head, bytesAt(at, headSize));
        ByteReader reader(head);
        reader.skip(index_.recordLength);
        std::uint64_t points = reader.read<std::uint32_t>();
        std::uint64_t bytes = headSize;
        while (reader.remaining() > 0)
            bytes += reader.read<std::uint32_t>();
        if (points == 0 || points / mostPointsPerByte > bytes || bytes > pointsEnd_ - at)
            break;
        addChunk(std::min(points, index_.pointCount - index_.starts.back()), bytes);
    }
    if (index_.starts.back() < index_.pointCount) {
        warnings_.push_back(cat("the header counts ", index_.pointCount, " points, but only ",
                                index_.starts.back(), " are in whole chunks"));
        index_.pointCount = index_.starts.back();
    }
    return {};
}

} // namespace

Result<ChunkIndex> readChunkIndex(ByteSource& source, const Header& header, std::uint64_t pointsEnd,
                                  std::vector<std::string>& warnings) {
    return IndexBuilder(source, header, pointsEnd, warnings).build();
}

} // namespace stipple::las::laz
