// Appends the points of a LAZ file: the place of the chunk table's offset, the chunks, the table.
//
// Memory: the compressed bytes of the chunk that is being written, and about 2 MB of models. With a ChunkWork
// also, of each chunk that waits, its records and then its bytes, and models for each that is compressed at
// the same time.
#pragma once

#include "shared/io/byte_sink.hpp"
#include "shared/las/chunk_work.hpp"
#include "shared/las/laz/chunk_table.hpp"
#include "shared/las/laz/laszip_record.hpp"

#include <deque>
#include <mutex>

namespace stipple::las::laz {

class ChunkWriter {
  public:
    // For files whose record (laszipRecordFor) says chunks of a fixed number of points. `to` can be
    // overwritten and outlives the writer. Without `work`, or where the records of a chunk are more than
    // mostRecordBytes, the thread that writes compresses; the bytes are the same. Errors: unsupported items.
    static Result<std::unique_ptr<ChunkWriter>> create(ByteSink& to, const LaszipRecord& record,
                                                       std::unique_ptr<ChunkWork> work = nullptr);
    static constexpr std::size_t mostRecordBytes = std::size_t{1} << 24;

    // Called once, where the points begin.
    Status begin();
    // Adds whole records.
    Status write(ByteSpan records);
    // Writes the last chunk and the table, and its offset at the beginning.
    Status finish();

  private:
    ChunkWriter(ByteSink& to, const LaszipRecord& record);
    Result<std::unique_ptr<ChunkEncoder>> makeEncoder() const;
    void encodeHere(ByteSpan records);
    Status finishChunk();
    Bytes compress(ByteSpan records);
    Status takeChunk();
    Status append(std::uint32_t points, ByteSpan bytes);

    ByteSink& to_;
    const LaszipRecord record_;
    std::size_t recordLength_ = 0;
    std::uint32_t pointsInChunk_ = 0;
    std::uint64_t beginOffset_ = 0;
    std::vector<Chunk> chunks_;
    std::mutex mutex_;                                    // of encoders_
    std::vector<std::unique_ptr<ChunkEncoder>> encoders_; // idle ones
    Bytes records_;                                       // of the chunk that is not full; with work_ only
    std::deque<std::uint32_t> waitingPoints_;             // of the chunks that wait
    std::unique_ptr<ChunkWork> work_;                     // last: it ends before what it uses
};

} // namespace stipple::las::laz
