// A file that is made in memory and taken away while it grows: the page keeps its pieces, so that they need
// no room in a program whose memory is bounded. What a format writes late into its beginning is told as
// patches.
#pragma once

#include "shared/io/byte_sink.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace stipple {

struct Pieces {
    Bytes fresh;                                          // not taken yet
    std::uint64_t offset = 0;                             // of fresh in the file
    std::vector<std::pair<std::uint64_t, Bytes>> patches; // for bytes that were taken; in order

    void append(ByteSpan bytes) { fresh.insert(fresh.end(), bytes.begin(), bytes.end()); }
    Bytes take() {
        offset += fresh.size();
        return std::exchange(fresh, {});
    }
};

class PieceSink final : public ByteSink {
  public:
    explicit PieceSink(std::shared_ptr<Pieces> to) : to_(std::move(to)) {}
    bool canOverwrite() const override { return true; }
    Status overwrite(std::uint64_t offset, ByteSpan bytes) override;
    Status finish() override { return {}; }

  private:
    Status put(ByteSpan bytes) override {
        to_->append(bytes);
        return {};
    }
    std::shared_ptr<Pieces> to_;
};

} // namespace stipple
