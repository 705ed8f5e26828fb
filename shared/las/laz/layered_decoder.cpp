#include "shared/las/laz/layered_chunk.hpp"
#include "shared/las/laz/layered_point.hpp"

#include <algorithm>

namespace stipple::las::laz {

namespace {

Error damaged(ErrorCode code, const std::string& what) {
    return {code, what, "", "the points of this chunk are lost; get the file again"};
}

class LayeredDecoder final : public ChunkDecoder {
  public:
    LayeredDecoder(LayeredLayout layout, Layers wanted)
        : layout_(std::move(layout)), fields_(layout_.fields()), wanted_(std::move(wanted)), point_(layout_),
          first_(layout_.recordLength), streams_(fields_.size()) {}

    Status start(ByteSpan chunk, std::uint64_t points) override;
    Status decode(std::span<std::uint8_t> records) override;

  private:
    bool wants(unsigned layer, std::uint32_t bit) const {
        return bit != 0 ? wanted_.has(bit)
                        : wanted_.hasExtraByte(layer - (streams_.size() - point_.extraBytes.size()));
    }
    Status decodeRun(std::uint8_t* records, std::size_t count);
    Status check(unsigned layer) const;

    LayeredLayout layout_;
    std::vector<LayerField> fields_;
    Layers wanted_;
    LayeredPoint point_;

    // Of this chunk. What every record starts as: the first one without what is not wanted.
    Bytes first_;
    std::vector<LayerReader> streams_; // without an end: nothing to decode
    bool allCoded_ = false;
    std::uint64_t decoded_ = 0;
    std::array<PointInfo, LayeredPoint::runPoints> infos_;
};

Status LayeredDecoder::start(ByteSpan chunk, std::uint64_t points) {
    ByteReader head(chunk);
    ByteSpan firstRecord = head.readBytes(layout_.recordLength);
    const auto count = head.read<std::uint32_t>();
    ByteSpan sizes = head.readBytes(4 * streams_.size());
    if (!head.ok())
        return damaged(ErrorCode::truncated, "the chunk ends after " + std::to_string(chunk.size()) +
                                                 " bytes, within its first point and layer sizes");
    if (count < points)
        return damaged(ErrorCode::corrupt, "the chunk says that it has " + std::to_string(count) +
                                               " points, the file " + std::to_string(points));
    for (std::size_t i = 0; i < streams_.size(); ++i) {
        const auto size = loadLe<std::uint32_t>(sizes.data() + 4 * i);
        if (size > head.remaining())
            return damaged(ErrorCode::truncated, "layer " + std::to_string(i + 1) + " of " +
                                                     std::to_string(streams_.size()) + " has " +
                                                     std::to_string(size) + " bytes, the chunk only " +
                                                     std::to_string(head.remaining()) + " more");
        ByteSpan layer = head.readBytes(size);
        streams_[i] = {};
        if (size != 0)
            streams_[i] = {ArithmeticDecoder(layer.data()), layer.data() + size};
    }
    if (streams_[0].end == nullptr && points > 1)
        return damaged(ErrorCode::corrupt, "the chunk's layer of X and Y is empty");

    std::copy(firstRecord.begin(), firstRecord.end(), first_.begin());
    decoded_ = 0;
    allCoded_ = true;
    const unsigned channel = PositionLayer::channelOf(first_.data());
    point_.position.start(first_.data());
    point_.forEachFurther(layout_, [&](unsigned i, std::uint32_t bit, auto& layer) {
        if (!wants(i, bit)) {
            streams_[i].end = nullptr;
            for (std::size_t k = 0; k < fields_[i].sizeBytes; ++k)
                first_[fields_[i].offsetBytes + k] &= static_cast<std::uint8_t>(~fields_[i].mask);
        }
        if (streams_[i].end != nullptr)
            layer.start(channel, first_.data());
        else
            allCoded_ = false;
    });
    return {};
}

Status LayeredDecoder::decode(std::span<std::uint8_t> records) {
    std::uint8_t* at = records.data();
    std::size_t left = records.size() / layout_.recordLength;
    if (decoded_ == 0 && left != 0) {
        std::copy(first_.begin(), first_.end(), at);
        at += layout_.recordLength;
        --left;
        ++decoded_;
    }
    while (left != 0) {
        const std::size_t count = std::min(left, LayeredPoint::runPoints);
        STIPPLE_CHECK(decodeRun(at, count));
        at += count * layout_.recordLength;
        left -= count;
        decoded_ += count;
    }
    return {};
}

Status LayeredDecoder::decodeRun(std::uint8_t* records, std::size_t count) {
    if (!allCoded_)
        for (std::size_t i = 0; i < count; ++i)
            std::copy(first_.begin(), first_.end(), records + i * layout_.recordLength);
    const PointRun<std::uint8_t> run{records, layout_.recordLength, count, infos_.data()};
    codeRun(streams_[0], point_.position, run);
    STIPPLE_CHECK(check(0));
    point_.forEachFurther(layout_, [&](unsigned i, std::uint32_t, auto& layer) {
        if (streams_[i].end != nullptr)
            codeRun(streams_[i], layer, run);
    });
    for (unsigned i = 1; i < streams_.size(); ++i)
        STIPPLE_CHECK(check(i));
    return {};
}

Status LayeredDecoder::check(unsigned layer) const {
    if (streams_[layer].end == nullptr || !streams_[layer].pastEnd())
        return {};
    return damaged(ErrorCode::corrupt, "layer " + std::to_string(layer + 1) + " of " +
                                           std::to_string(streams_.size()) + " ends within the " +
                                           std::to_string(LayeredPoint::runPoints) + " points behind point " +
                                           std::to_string(decoded_) + " of the chunk");
}

} // namespace

Result<std::unique_ptr<ChunkDecoder>> makeLayeredDecoder(const Items& items, const Layers& wanted) {
    STIPPLE_TRY(layout, layeredLayout(items));
    if (!wanted.extraBytes.empty() && wanted.extraBytes.size() != layout.extraBytes.sizeBytes)
        return Error{ErrorCode::invalidArgument,
                     "wanted extra bytes are told for " + std::to_string(wanted.extraBytes.size()) + " of " +
                         std::to_string(layout.extraBytes.sizeBytes),
                     "", ""};
    return std::unique_ptr<ChunkDecoder>(std::make_unique<LayeredDecoder>(std::move(layout), wanted));
}

} // namespace stipple::las::laz
