#include "shared/las/laz/chunk_writer.hpp"

#include "shared/base/text.hpp"
#include "shared/las/laz/layered_chunk.hpp"
#include "shared/las/laz/pointwise_codec.hpp"

#include <algorithm>
#include <limits>

namespace stipple::las::laz {

ChunkWriter::ChunkWriter(ByteSink& to, const LaszipRecord& record) : to_(to), chunkSize_(record.chunkSize) {
    for (const Item& item : record.items)
        recordLength_ += item.sizeBytes;
}

Result<std::unique_ptr<ChunkWriter>> ChunkWriter::create(ByteSink& to, const LaszipRecord& record) {
    std::unique_ptr<ChunkWriter> writer(new ChunkWriter(to, record));
    if (record.compressor == Compressor::layeredChunked) {
        STIPPLE_TRY(encoder, makeLayeredEncoder(record.items));
        writer->encoder_ = std::move(encoder);
    } else {
        writer->encoder_ = makePointwiseEncoder(record.items);
    }
    return writer;
}

Status ChunkWriter::begin() {
    beginOffset_ = to_.sizeBytes();
    ByteWriter place;
    place.write(std::int64_t{-1}); // not known yet: what a file that is never finished says
    return to_.append(place.bytes());
}

Status ChunkWriter::write(ByteSpan records) {
    while (!records.empty()) {
        if (pointsInChunk_ == 0)
            encoder_->start();
        const std::size_t room = std::size_t{chunkSize_ - pointsInChunk_} * recordLength_;
        ByteSpan part = records.first(std::min(records.size(), room));
        encoder_->encode(part);
        pointsInChunk_ += static_cast<std::uint32_t>(part.size() / recordLength_);
        records = records.subspan(part.size());
        if (pointsInChunk_ == chunkSize_)
            STIPPLE_CHECK(finishChunk());
    }
    return {};
}

Status ChunkWriter::finishChunk() {
    ByteSpan bytes = encoder_->finish();
    if (bytes.size() > std::numeric_limits<std::uint32_t>::max() ||
        chunks_.size() == std::numeric_limits<std::uint32_t>::max())
        return Error{ErrorCode::limitExceeded, "LAZ counts chunks and their bytes in 32 bits", to_.name(),
                     ""};
    chunks_.push_back({pointsInChunk_, static_cast<std::uint32_t>(bytes.size())});
    pointsInChunk_ = 0;
    return to_.append(bytes);
}

Status ChunkWriter::finish() {
    if (pointsInChunk_ > 0)
        STIPPLE_CHECK(finishChunk());
    ByteWriter offset;
    offset.write(to_.sizeBytes());
    STIPPLE_CHECK(to_.append(encodeChunkTable(chunks_, false)));
    return to_.overwrite(beginOffset_, offset.bytes());
}

} // namespace stipple::las::laz
