// A file that gets its name only when it is complete (POSIX). Until commit() the bytes lie in a temporary
// file beside it, which is removed when the OutputFile goes first.
//
// Errors: writeFailed with the system's reason (no space, no permission, …). Thread: one.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <memory>
#include <string>
#include <utility>

namespace stipple {

class OutputFile {
  public:
    static Result<std::unique_ptr<OutputFile>> create(const std::string& path);
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    ~OutputFile();

    Status append(ByteSpan bytes);
    // Overwrites bytes that were appended before: offset + bytes.size() <= sizeBytes().
    Status overwrite(std::uint64_t offset, ByteSpan bytes);
    // Closes and renames, replacing a file of that name. Nothing may be written afterwards.
    Status commit();

    std::uint64_t sizeBytes() const { return size_; }
    const std::string& path() const { return path_; }

  private:
    OutputFile(int descriptor, std::string path, std::string temporaryPath)
        : descriptor_(descriptor), path_(std::move(path)), temporaryPath_(std::move(temporaryPath)) {}
    Status writeAt(std::uint64_t offset, ByteSpan bytes);
    Error failure(const char* what) const;

    int descriptor_; // -1: committed or given up
    std::string path_, temporaryPath_;
    std::uint64_t size_ = 0;
};

} // namespace stipple
