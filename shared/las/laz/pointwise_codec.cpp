#include "shared/las/laz/pointwise_codec.hpp"

#include "shared/base/text.hpp"
#include "shared/las/laz/byte_item.hpp"
#include "shared/las/laz/gps_time11.hpp"
#include "shared/las/laz/point10.hpp"
#include "shared/las/laz/rgb12.hpp"
#include "shared/las/laz/wave_packet13.hpp"

#include <algorithm>

// For lambdas, behind their parameters.
#define STIPPLE_LAZ_INLINED __attribute__((always_inline))

namespace stipple::las::laz {

namespace {

// The items of a record, each where it lies in it. Those a format lacks are null: a branch that is always
// predicted costs less than a program for each of the combinations.
class RecordCodec {
  public:
    explicit RecordCodec(const Items& items) {
        for (const Item& item : items) {
            place(item);
            recordLength_ += item.sizeBytes;
        }
    }

    std::size_t recordLength() const { return recordLength_; }
    std::size_t maxBytes() const { return maxBytes_; }

    void start(const std::uint8_t* first) {
        each([&](auto& item, std::size_t offset) { item.start(first + offset); });
    }

    template <class Coder, class Byte>
    STIPPLE_LAZ_INLINE Coder code(Coder coder, Byte* record) {
        each([&](auto& item, std::size_t offset)
                 STIPPLE_LAZ_INLINED { coder = item.code(coder, record + offset); });
        return coder;
    }

  private:
    template <class T>
    struct Placed {
        std::unique_ptr<T> item;
        std::size_t offset = 0;
    };

    template <class T, class... Arguments>
    void make(Placed<T>& placed, std::size_t maxBytes, Arguments... arguments) {
        placed = {std::make_unique<T>(arguments...), recordLength_};
        maxBytes_ += maxBytes;
    }

    void place(const Item& item) {
        const bool first = item.version == 1;
        const std::size_t count = item.sizeBytes;
        switch (item.type) {
        case ItemType::point10:
            return first ? make(point1_, Point10V1::maxBytes) : make(point2_, Point10V2::maxBytes);
        case ItemType::gpsTime11:
            return first ? make(time1_, GpsTime11V1::maxBytes) : make(time2_, GpsTime11V2::maxBytes);
        case ItemType::rgb12:
            return first ? make(rgb1_, Rgb12V1::maxBytes) : make(rgb2_, Rgb12V2::maxBytes);
        case ItemType::wavePacket13:
            return make(wave_, WavePacket13V1::maxBytes);
        default:
            return first ? make(bytes1_, count * BytesV1::maxBytesEach, count)
                         : make(bytes2_, count * BytesV2::maxBytesEach, count);
        }
    }

    // In the order of the record, which is that of LAS for any list of items.
    template <class Function>
    STIPPLE_LAZ_INLINE void each(Function&& apply) {
        auto visit = [&](auto& placed) STIPPLE_LAZ_INLINED {
            if (placed.item)
                apply(*placed.item, placed.offset);
        };
        visit(point2_);
        visit(point1_);
        visit(time2_);
        visit(time1_);
        visit(rgb2_);
        visit(rgb1_);
        visit(wave_);
        visit(bytes2_);
        visit(bytes1_);
    }

    Placed<Point10V1> point1_;
    Placed<Point10V2> point2_;
    Placed<GpsTime11V1> time1_;
    Placed<GpsTime11V2> time2_;
    Placed<Rgb12V1> rgb1_;
    Placed<Rgb12V2> rgb2_;
    Placed<WavePacket13V1> wave_;
    Placed<BytesV1> bytes1_;
    Placed<BytesV2> bytes2_;
    std::size_t recordLength_ = 0, maxBytes_ = 0;
};

} // namespace

struct PointwiseDecoder::State {
    explicit State(const Items& items) : codec(items) {}

    RecordCodec codec;
    ArithmeticDecoder decoder;
    ByteSpan bytes;
    bool atFirst = true; // the raw record comes next
};

PointwiseDecoder::PointwiseDecoder(const Items& items) : state_(std::make_unique<State>(items)) {}
PointwiseDecoder::~PointwiseDecoder() = default;

std::size_t PointwiseDecoder::bytesPerRecord() const {
    return state_->codec.maxBytes() + state_->codec.recordLength();
}

std::size_t PointwiseDecoder::position() const {
    return static_cast<std::size_t>(state_->decoder.position() - state_->bytes.data());
}

void PointwiseDecoder::continueAt(ByteSpan bytes) {
    state_->bytes = bytes;
    state_->decoder.moveTo(bytes.data());
}

Status PointwiseDecoder::start(ByteSpan chunk, std::uint64_t) {
    const std::size_t needed = state_->codec.recordLength() + ArithmeticDecoder::startBytes;
    if (chunk.size() < needed)
        return Error{
            ErrorCode::truncated,
            cat("the chunk of compressed points has ", chunk.size(), " bytes, but begins with ", needed), "",
            ""};
    state_->bytes = chunk;
    state_->decoder = ArithmeticDecoder(chunk.data() + state_->codec.recordLength());
    state_->atFirst = true;
    return {};
}

Status PointwiseDecoder::decode(std::span<std::uint8_t> records) {
    RecordCodec& codec = state_->codec;
    const std::size_t length = codec.recordLength();
    if (state_->atFirst && !records.empty()) {
        std::copy_n(state_->bytes.data(), length, records.data());
        codec.start(records.data());
        state_->atFirst = false;
        records = records.subspan(length);
    }
    ArithmeticDecoder decoder = state_->decoder;
    const std::uint8_t* const end = state_->bytes.data() + state_->bytes.size();
    std::uint8_t* const recordsEnd = records.data() + records.size();
    for (std::uint8_t* record = records.data(); record != recordsEnd; record += length) {
        decoder = codec.code(decoder, record);
        if (decoder.position() > end) [[unlikely]]
            return Error{ErrorCode::truncated, "the chunk of compressed points ends before its last point",
                         "", "the points of this chunk are lost; get the file again"};
    }
    state_->decoder = decoder;
    return {};
}

namespace {

class PointwiseEncoder final : public ChunkEncoder {
  public:
    explicit PointwiseEncoder(const Items& items) : codec_(items) {}

    void start() override { atFirst_ = true; }

    void encode(ByteSpan records) override {
        const std::size_t length = codec_.recordLength();
        if (atFirst_ && !records.empty()) {
            stream_.startBehind(records.first(length));
            codec_.start(records.data());
            atFirst_ = false;
            records = records.subspan(length);
        }
        stream_.ensureRoom(records.size() / length * codec_.maxBytes());
        ArithmeticEncoder encoder = stream_.encoder;
        const std::uint8_t* const end = records.data() + records.size();
        for (const std::uint8_t* record = records.data(); record != end; record += length)
            encoder = codec_.code(encoder, record);
        stream_.encoder = encoder;
    }

    ByteSpan finish() override { return stream_.finish(); }

  private:
    RecordCodec codec_;
    EncodedStream stream_;
    bool atFirst_ = true;
};

} // namespace

std::unique_ptr<ChunkEncoder> makePointwiseEncoder(const Items& items) {
    return std::make_unique<PointwiseEncoder>(items);
}

} // namespace stipple::las::laz
