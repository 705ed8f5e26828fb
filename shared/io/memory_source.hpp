// A byte source over a buffer that the source owns. Answers inside read().
#pragma once

#include "shared/io/byte_source.hpp"

namespace stipple {

class MemorySource final : public ByteSource {
  public:
    explicit MemorySource(Bytes bytes, std::string name = "memory")
        : bytes_(std::move(bytes)), name_(std::move(name)) {}

    RequestId read(ByteRange range, Completion done) override;
    std::uint64_t sizeBytes() const override { return bytes_.size(); }
    std::string name() const override { return name_; }

  private:
    Bytes bytes_;
    std::string name_;
    RequestId next_ = 0;
};

} // namespace stipple
