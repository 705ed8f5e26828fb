#include "shared/las/laz/chunk_reader.hpp"

#include "shared/base/text.hpp"
#include "shared/las/laz/layered_chunk.hpp"

#include <algorithm>

namespace stipple::las::laz {

namespace {

constexpr std::uint64_t windowLimit = 4 * 1024 * 1024;
constexpr std::uint64_t nowhere = ~0ull;

} // namespace

ChunkReader::ChunkReader(ByteSource& source, std::shared_ptr<const ChunkIndex> index)
    : source_(source), index_(std::move(index)) {
    if (!isLayered())
        pointwise_ = std::make_unique<PointwiseDecoder>(index_->record.items);
}

void ChunkReader::select(Layers layers) {
    if (!isLayered())
        return;
    layers_ = std::move(layers);
    layered_ = nullptr;
    open_ = false;
}

Error ChunkReader::placed(const Error& error) const {
    return error.at(cat("the chunk of points from ", chunkFirst_, " on, at byte ", chunkOffset_));
}

Status ChunkReader::seek(std::uint64_t first) {
    if (first == next_)
        return {};
    const bool ahead = open_ && first > next_ && (index_->sequential || first < chunkFirst_ + chunkPoints_);
    if (ahead)
        return skip(first - next_);
    open_ = false;
    next_ = first;
    return {};
}

Status ChunkReader::skip(std::uint64_t points) {
    const std::size_t length = index_->recordLength;
    const std::uint64_t block = std::max<std::uint64_t>(1, 64 * 1024 / length);
    while (points > 0) {
        std::uint64_t part = std::min(points, block);
        skipped_.resize(static_cast<std::size_t>(part) * length);
        STIPPLE_CHECK(read(skipped_));
        points -= part;
    }
    return {};
}

Status ChunkReader::openNext() {
    if (open_ && index_->sequential) {
        const std::uint64_t size = index_->record.chunkSize;
        chunkOffset_ = decoderOffset_ + pointwise_->position();
        chunkFirst_ += chunkPoints_;
        chunkPoints_ = std::min(size, index_->pointCount - chunkFirst_);
        return startChunk();
    }
    const std::uint64_t target = next_;
    const auto& starts = index_->starts;
    auto chunk =
        static_cast<std::size_t>(std::upper_bound(starts.begin(), starts.end(), target) - starts.begin() - 1);
    chunkFirst_ = next_ = starts[chunk];
    chunkPoints_ = starts[chunk + 1] - chunkFirst_;
    if (index_->sequential)
        chunkPoints_ = std::min<std::uint64_t>(index_->record.chunkSize, index_->pointCount);
    chunkOffset_ = index_->offsets[chunk];
    chunkEnd_ = index_->offsets[chunk + 1];
    isLast_ = chunk + 2 == starts.size();
    STIPPLE_CHECK(startChunk());
    return skip(target - chunkFirst_);
}

Status ChunkReader::startChunk() {
    open_ = false;
    const std::uint64_t size = chunkEnd_ - chunkOffset_;
    if (isLayered()) {
        if (!layered_) {
            STIPPLE_TRY(decoder, makeLayeredDecoder(index_->record.items, layers_));
            layered_ = std::move(decoder);
        }
        STIPPLE_CHECK(readWindow(chunkOffset_, size));
        if (Status started = layered_->start(ByteSpan(window_.data(), windowBytes_), chunkPoints_);
            !started.ok())
            return placed(started.error());
    } else {
        STIPPLE_CHECK(windowAt(chunkOffset_, index_->recordLength + 64));
        if (Status started = pointwise_->start(windowFrom(chunkOffset_), chunkPoints_); !started.ok())
            return placed(started.error());
        decoderOffset_ = chunkOffset_;
    }
    open_ = true;
    return {};
}

Status ChunkReader::readWindow(std::uint64_t offset, std::uint64_t size) {
    windowBytes_ = 0;
    STIPPLE_TRY(bytes, readNow(source_, {offset, size}));
    if (bytes.size() != size)
        return Error{ErrorCode::changed, "the file became shorter while it was read", cat("byte ", offset),
                     "open it again"};
    window_ = std::move(bytes);
    windowOffset_ = offset;
    windowBytes_ = window_.size();
    window_.resize(windowBytes_ + decodePadding(index_->recordLength));
    return {};
}

ByteSpan ChunkReader::windowFrom(std::uint64_t offset) const {
    return ByteSpan(window_.data(), windowBytes_).subspan(static_cast<std::size_t>(offset - windowOffset_));
}

// Makes sure that the window holds `needed` bytes from `offset` on, or all up to the chunk's end.
Status ChunkReader::windowAt(std::uint64_t offset, std::uint64_t needed) {
    const std::uint64_t windowEnd = windowOffset_ + windowBytes_;
    needed = std::min(needed, chunkEnd_ - offset);
    if (offset >= windowOffset_ && offset <= windowEnd && windowEnd - offset >= needed)
        return {};
    return readWindow(offset, std::min(std::max(needed, windowLimit), chunkEnd_ - offset));
}

Status ChunkReader::decodePointwise(std::span<std::uint8_t> records) {
    const std::size_t length = index_->recordLength;
    const std::size_t worst = pointwise_->bytesPerRecord();
    const std::size_t most =
        std::max<std::size_t>(1, static_cast<std::size_t>(windowLimit) / 4 / worst) * length;
    while (!records.empty()) {
        // Whole where the chunk is; otherwise so many that they end inside the window whatever they are.
        const bool whole = windowOffset_ + windowBytes_ >= chunkEnd_;
        auto part = records.first(whole ? records.size() : std::min(most, records.size()));
        if (!whole) {
            const std::uint64_t at = decoderOffset_ + pointwise_->position();
            const std::uint64_t before = windowOffset_;
            STIPPLE_CHECK(windowAt(at, part.size() / length * worst));
            if (windowOffset_ != before) {
                pointwise_->continueAt(windowFrom(at));
                decoderOffset_ = at;
            }
        }
        STIPPLE_CHECK(pointwise_->decode(part));
        records = records.subspan(part.size());
    }
    return {};
}

Status ChunkReader::checkEnd() const {
    // The header may count fewer points than the last chunk has.
    if (isLayered() || index_->sequential || isLast_)
        return {};
    const std::uint64_t end = decoderOffset_ + pointwise_->position();
    if (end == chunkEnd_)
        return {};
    return Error{ErrorCode::corrupt,
                 cat("its points end at byte ", end, ", but the next chunk begins at ", chunkEnd_), "",
                 "the file is damaged; copy it again"};
}

Status ChunkReader::read(std::span<std::uint8_t> records) {
    const std::size_t length = index_->recordLength;
    while (!records.empty()) {
        if (!open_ || next_ == chunkFirst_ + chunkPoints_)
            if (Status opened = openNext(); !opened.ok()) {
                next_ = nowhere;
                return opened;
            }
        const std::uint64_t left = chunkFirst_ + chunkPoints_ - next_;
        const std::size_t count =
            static_cast<std::size_t>(std::min<std::uint64_t>(left, records.size() / length));
        auto part = records.first(count * length);
        Status decoded = isLayered() ? layered_->decode(part) : decodePointwise(part);
        next_ += count;
        if (decoded.ok() && count == left)
            decoded = checkEnd();
        if (!decoded.ok()) {
            open_ = false;
            next_ = nowhere;
            return placed(decoded.error());
        }
        records = records.subspan(part.size());
    }
    return {};
}

} // namespace stipple::las::laz
