// Appends the points of a LAZ file: the place of the chunk table's offset, the chunks, the table.
//
// Memory: the compressed bytes of the chunk that is being written, and about 2 MB of models.
#pragma once

#include "shared/io/byte_sink.hpp"
#include "shared/las/laz/chunk_table.hpp"
#include "shared/las/laz/laszip_record.hpp"

namespace stipple::las::laz {

class ChunkWriter {
  public:
    // For files whose record (laszipRecordFor) says chunks of a fixed number of points. `to` can be
    // overwritten and outlives the writer. Errors: unsupported items.
    static Result<std::unique_ptr<ChunkWriter>> create(ByteSink& to, const LaszipRecord& record);

    // Called once, where the points begin.
    Status begin();
    // Adds whole records.
    Status write(ByteSpan records);
    // Writes the last chunk and the table, and its offset at the beginning.
    Status finish();

  private:
    ChunkWriter(ByteSink& to, const LaszipRecord& record);
    Status finishChunk();

    ByteSink& to_;
    std::unique_ptr<ChunkEncoder> encoder_;
    std::size_t recordLength_ = 0;
    std::uint32_t chunkSize_ = 0, pointsInChunk_ = 0;
    std::uint64_t beginOffset_ = 0;
    std::vector<Chunk> chunks_;
};

} // namespace stipple::las::laz
