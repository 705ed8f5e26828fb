// Chunks of pointwise compression (compressors 1 and 2): the first record as it is, then one arithmetic
// stream in which the items of each point follow one another.
#pragma once

#include "shared/las/laz/chunk_codec.hpp"

namespace stipple::las::laz {

// Also decodes chunks that are not in memory as a whole: start() with the first bytes of one, then, whenever
// less than bytesPerRecord() × records are left, continueAt() with those from position() on.
class PointwiseDecoder final : public ChunkDecoder {
  public:
    // Items of versions 1 and 2 (Laszip::parse has checked them).
    explicit PointwiseDecoder(const Items& items);
    ~PointwiseDecoder() override;

    Status start(ByteSpan chunk, std::uint64_t points) override;
    Status decode(std::span<std::uint8_t> records) override;

    // Bytes of those given last that are decoded: once the chunk's points are read, where it ends.
    std::size_t position() const;
    void continueAt(ByteSpan bytes);
    // What a record takes at most, whatever the bytes are.
    std::size_t bytesPerRecord() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// An encoder of items of versions 1 and 2.
std::unique_ptr<ChunkEncoder> makePointwiseEncoder(const Items& items);

} // namespace stipple::las::laz
