// Where an export's bytes go: a file that gets its name when it is complete, standard output, later the body
// of an HTTP answer.
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

    virtual Status append(ByteSpan bytes) = 0;
    // Can bytes that were appended be written again? Not those that are on their way to someone.
    virtual bool canOverwrite() const { return false; }
    virtual Status overwrite(std::uint64_t offset, ByteSpan bytes);
    // All bytes are there: the file gets its name.
    virtual Status finish() = 0;
};

Result<std::unique_ptr<ByteSink>> fileSink(const std::string& path);
std::unique_ptr<ByteSink> standardOutputSink();

} // namespace stipple
