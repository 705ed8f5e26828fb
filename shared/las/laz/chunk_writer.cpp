#include "shared/las/laz/chunk_writer.hpp"

#include "shared/base/text.hpp"
#include "shared/las/laz/layered_chunk.hpp"
#include "shared/las/laz/pointwise_codec.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace stipple::las::laz {

ChunkWriter::ChunkWriter(ByteSink& to, const LaszipRecord& record) : to_(to), record_(record) {
    for (const Item& item : record.items)
        recordLength_ += item.sizeBytes;
}

Result<std::unique_ptr<ChunkEncoder>> ChunkWriter::makeEncoder() const {
    if (record_.compressor == Compressor::layeredChunked)
        return makeLayeredEncoder(record_.items);
    return makePointwiseEncoder(record_.items);
}

Result<std::unique_ptr<ChunkWriter>> ChunkWriter::create(ByteSink& to, const LaszipRecord& record,
                                                         std::unique_ptr<ChunkWork> work) {
    std::unique_ptr<ChunkWriter> writer(new ChunkWriter(to, record));
    STIPPLE_TRY(encoder, writer->makeEncoder());
    writer->encoders_.push_back(std::move(encoder));
    if (std::uint64_t{record.chunkSize} * writer->recordLength_ <= mostRecordBytes)
        writer->work_ = std::move(work);
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
        const std::size_t room = std::size_t{record_.chunkSize - pointsInChunk_} * recordLength_;
        ByteSpan part = records.first(std::min(records.size(), room));
        if (work_)
            records_.insert(records_.end(), part.begin(), part.end());
        else
            encodeHere(part);
        pointsInChunk_ += static_cast<std::uint32_t>(part.size() / recordLength_);
        records = records.subspan(part.size());
        if (pointsInChunk_ == record_.chunkSize)
            STIPPLE_CHECK(finishChunk());
    }
    return {};
}

void ChunkWriter::encodeHere(ByteSpan records) {
    if (pointsInChunk_ == 0)
        encoders_[0]->start();
    encoders_[0]->encode(records);
}

Status ChunkWriter::finishChunk() {
    const std::uint32_t points = std::exchange(pointsInChunk_, 0);
    if (!work_)
        return append(points, encoders_[0]->finish());
    while (work_->waiting() >= work_->mostWaiting())
        STIPPLE_CHECK(takeChunk());
    waitingPoints_.push_back(points);
    // std::function holds what can be copied.
    auto records = std::make_shared<Bytes>(std::move(records_));
    work_->submit([this, records] { return compress(*records); });
    records_ = Bytes();
    records_.reserve(std::size_t{record_.chunkSize} * recordLength_);
    return {};
}

// On any thread.
Bytes ChunkWriter::compress(ByteSpan records) {
    std::unique_ptr<ChunkEncoder> encoder;
    {
        std::lock_guard lock(mutex_);
        if (!encoders_.empty()) {
            encoder = std::move(encoders_.back());
            encoders_.pop_back();
        }
    }
    if (!encoder)
        encoder = std::move(makeEncoder()).value(); // one of the kind was made before
    encoder->start();
    encoder->encode(records);
    ByteSpan bytes = encoder->finish();
    Bytes chunk(bytes.begin(), bytes.end());
    std::lock_guard lock(mutex_);
    encoders_.push_back(std::move(encoder));
    return chunk;
}

Status ChunkWriter::takeChunk() {
    STIPPLE_TRY(bytes, work_->take());
    const std::uint32_t points = waitingPoints_.front();
    waitingPoints_.pop_front();
    return append(points, bytes);
}

Status ChunkWriter::append(std::uint32_t points, ByteSpan bytes) {
    if (bytes.size() > std::numeric_limits<std::uint32_t>::max() ||
        chunks_.size() == std::numeric_limits<std::uint32_t>::max())
        return Error{ErrorCode::limitExceeded, "LAZ counts chunks and their bytes in 32 bits", to_.name(),
                     ""};
    chunks_.push_back({points, static_cast<std::uint32_t>(bytes.size())});
    return to_.append(bytes);
}

Status ChunkWriter::finish() {
    if (pointsInChunk_ > 0)
        STIPPLE_CHECK(finishChunk());
    while (!waitingPoints_.empty())
        STIPPLE_CHECK(takeChunk());
    ByteWriter offset;
    offset.write(to_.sizeBytes());
    STIPPLE_CHECK(to_.append(encodeChunkTable(chunks_, false)));
    return to_.overwrite(beginOffset_, offset.bytes());
}

} // namespace stipple::las::laz
