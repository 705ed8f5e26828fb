// Where the bytes of a file that is being made go: a file that gets its name when it is complete, memory,
// standard output, the body of an HTTP answer. Thread: one.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace stipple {

class ByteSink {
  public:
    virtual ~ByteSink() = default; // without finish(): nothing of a file is left

    Status append(ByteSpan bytes);
    std::uint64_t sizeBytes() const { return size_; } // that were appended
    // Can bytes that were appended be written again? Not those that are on their way to someone.
    virtual bool canOverwrite() const { return false; }
    // Bytes that were appended before: offset + bytes.size() <= sizeBytes().
    virtual Status overwrite(std::uint64_t offset, ByteSpan bytes);
    // All bytes are there: the file gets its name.
    virtual Status finish() = 0;
    virtual std::string name() const { return ""; } // for messages

  protected:
    virtual Status put(ByteSpan bytes) = 0;

  private:
    std::uint64_t size_ = 0;
};

Result<std::unique_ptr<ByteSink>> fileSink(const std::string& path);

// Keeps the bytes in `to`, which outlives it and was empty.
class MemorySink final : public ByteSink {
  public:
    explicit MemorySink(Bytes& to) : to_(to) {}
    bool canOverwrite() const override { return true; }
    Status overwrite(std::uint64_t offset, ByteSpan bytes) override;
    Status finish() override { return {}; }

  private:
    Status put(ByteSpan bytes) override;
    Bytes& to_;
};

} // namespace stipple
