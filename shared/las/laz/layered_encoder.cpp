#include "shared/las/laz/layered_chunk.hpp"
#include "shared/las/laz/layered_point.hpp"

#include <algorithm>

namespace stipple::las::laz {

namespace {

class LayeredEncoder final : public ChunkEncoder {
  public:
    explicit LayeredEncoder(LayeredLayout layout)
        : layout_(std::move(layout)), fields_(layout_.fields()), point_(layout_), streams_(fields_.size()),
          changed_(fields_.size()) {}

    void start() override {
        count_ = 0;
        for (auto& stream : streams_)
            stream.start();
        std::fill(changed_.begin(), changed_.end(), false);
        changed_[0] = changed_[1] = true; // X, Y and Z are always there
    }
    void encode(ByteSpan records) override;
    ByteSpan finish() override;

  private:
    void startLayers();
    void encodeRun(const std::uint8_t* records, std::size_t count);
    bool anyDiffers(const PointRun<const std::uint8_t>& run, const LayerField& field) const;

    LayeredLayout layout_;
    std::vector<LayerField> fields_;
    LayeredPoint point_;

    // Of this chunk.
    Bytes first_, chunk_;
    std::vector<EncodedStream> streams_;
    std::vector<bool> changed_; // layers that are not the first record's all through
    std::uint32_t count_ = 0;
    std::array<PointInfo, LayeredPoint::runPoints> infos_;
};

void LayeredEncoder::encode(ByteSpan records) {
    const std::uint8_t* at = records.data();
    std::size_t left = records.size() / layout_.recordLength;
    if (count_ == 0 && left != 0) {
        first_.assign(at, at + layout_.recordLength);
        startLayers();
        at += layout_.recordLength;
        --left;
        ++count_;
    }
    while (left != 0) {
        const std::size_t count = std::min(left, LayeredPoint::runPoints);
        encodeRun(at, count);
        at += count * layout_.recordLength;
        left -= count;
        count_ += static_cast<std::uint32_t>(count);
    }
}

void LayeredEncoder::startLayers() {
    const unsigned channel = PositionLayer::channelOf(first_.data());
    point_.position.start(first_.data());
    point_.forEachFurther(layout_,
                          [&](unsigned, std::uint32_t, auto& layer) { layer.start(channel, first_.data()); });
}

void LayeredEncoder::encodeRun(const std::uint8_t* records, std::size_t count) {
    const PointRun<const std::uint8_t> run{records, layout_.recordLength, count, infos_.data()};
    auto code = [&](unsigned i, auto& layer) {
        streams_[i].ensureRoom(count * layer.maxBytes);
        LayerWriter writer{streams_[i].encoder};
        codeRun(writer, layer, run);
        streams_[i].encoder = writer.coder;
    };
    code(0, point_.position);
    point_.forEachFurther(layout_, [&](unsigned i, std::uint32_t, auto& layer) {
        code(i, layer);
        if (!changed_[i])
            changed_[i] = anyDiffers(run, fields_[i]);
    });
}

bool LayeredEncoder::anyDiffers(const PointRun<const std::uint8_t>& run, const LayerField& field) const {
    const std::uint8_t* record = run.records;
    for (std::size_t i = 0; i < run.count; ++i, record += run.recordLength)
        for (std::size_t k = field.offsetBytes; k < field.offsetBytes + field.sizeBytes; ++k)
            if ((record[k] ^ first_[k]) & field.mask)
                return true;
    return false;
}

ByteSpan LayeredEncoder::finish() {
    chunk_.resize(first_.size() + 4 * (1 + streams_.size()));
    std::copy(first_.begin(), first_.end(), chunk_.begin());
    storeLe(chunk_.data() + first_.size(), count_);
    for (std::size_t i = 0; i < streams_.size(); ++i) {
        ByteSpan layer = changed_[i] ? streams_[i].finish() : ByteSpan{};
        storeLe(chunk_.data() + first_.size() + 4 * (1 + i), static_cast<std::uint32_t>(layer.size()));
        chunk_.insert(chunk_.end(), layer.begin(), layer.end());
    }
    return chunk_;
}

} // namespace

Result<std::unique_ptr<ChunkEncoder>> makeLayeredEncoder(const Items& items) {
    STIPPLE_TRY(layout, layeredLayout(items));
    return std::unique_ptr<ChunkEncoder>(std::make_unique<LayeredEncoder>(std::move(layout)));
}

} // namespace stipple::las::laz
