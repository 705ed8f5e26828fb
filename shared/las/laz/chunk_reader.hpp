// The points of a LAZ file as records, chunk after chunk.
//
// Memory: the bytes of one chunk; of pointwise chunks larger than a window of 4 MiB, that window.
#pragma once

#include "shared/las/laz/chunk_index.hpp"
#include "shared/las/laz/pointwise_codec.hpp"

namespace stipple::las::laz {

class ChunkReader {
  public:
    ChunkReader(ByteSource& source, std::shared_ptr<const ChunkIndex> index);

    // What later reads decode of layered chunks; pointwise ones are decoded whole.
    void select(Layers layers);

    // Point `first` (up to pointCount) comes next. Going on where the last read ended costs nothing, another
    // place the decoding of its chunk up to there (of all before, where the index is sequential).
    Status seek(std::uint64_t first);
    // The next records.size() / recordLength points; never more than there are. Errors: truncated, corrupt,
    // those of the source; the next seek() may begin anew.
    Status read(std::span<std::uint8_t> records);

  private:
    Status openNext();
    Status startChunk();
    Status readWindow(std::uint64_t offset, std::uint64_t size);
    Status windowAt(std::uint64_t offset, std::uint64_t needed);
    ByteSpan windowFrom(std::uint64_t offset) const;
    Status decodePointwise(std::span<std::uint8_t> records);
    Status checkEnd() const;
    Status skip(std::uint64_t points);
    Error placed(const Error& error) const;
    bool isLayered() const { return index_->record.compressor == Compressor::layeredChunked; }

    ByteSource& source_;
    std::shared_ptr<const ChunkIndex> index_;
    std::unique_ptr<PointwiseDecoder> pointwise_;
    std::unique_ptr<ChunkDecoder> layered_;
    Layers layers_;
    std::uint64_t next_ = 0;
    // The open chunk: its points, and where its bytes are (where it ends at most, if the index is
    // sequential).
    bool open_ = false, isLast_ = false;
    std::uint64_t chunkFirst_ = 0, chunkPoints_ = 0, chunkOffset_ = 0, chunkEnd_ = 0;
    std::uint64_t decoderOffset_ = 0; // in the file, of the bytes that the decoder was given last
    std::uint64_t windowOffset_ = 0;
    std::size_t windowBytes_ = 0;
    Bytes window_; // and padding
    Bytes skipped_;
};

} // namespace stipple::las::laz
