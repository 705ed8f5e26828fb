// A file for bytes that a program can't keep in memory, written and read back at any place (POSIX). It is
// removed with the object, unless it was told to stay.
//
// Errors: writeFailed with the system's reason and what to do (no space, no permission). Thread: any; parts
// that are being written must not be read or written by another.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

namespace stipple {

class ScratchFile {
  public:
    // A new, empty file; one of that name is emptied.
    static Result<std::unique_ptr<ScratchFile>> create(const std::string& path);
    // One that an earlier run left. notFound if there is none.
    static Result<std::unique_ptr<ScratchFile>> open(const std::string& path);
    // A new file in `folder` that has no name: it goes with the object, or with the process however that
    // ends.
    static Result<std::unique_ptr<ScratchFile>> createNameless(const std::string& folder);
    ~ScratchFile();
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;

    // Reserves `size` bytes at the end and returns where they begin.
    std::uint64_t reserve(std::uint64_t size) { return end_.fetch_add(size); }
    Status write(std::uint64_t offset, ByteSpan bytes);
    Status read(std::uint64_t offset, std::span<std::uint8_t> to) const;

    // Gives the disk back the space of these bytes, where the file system can; they read as zeros then.
    void discard(std::uint64_t offset, std::uint64_t size);

    // Where reserve() goes on: the end of what is in use.
    std::uint64_t end() const { return end_; }
    void setEnd(std::uint64_t offset) { end_ = offset; }

    // The file stays when the object goes.
    void keep() { keep_ = true; }
    // Its folder if it has no name.
    const std::string& path() const { return path_; }
    int descriptor() const { return descriptor_; } // open as long as the object lives

  private:
    ScratchFile(int descriptor, std::string path, std::uint64_t end)
        : descriptor_(descriptor), path_(std::move(path)), end_(end) {}
    Error failure(const char* what) const;

    int descriptor_;
    std::string path_;
    std::atomic<std::uint64_t> end_;
    std::atomic<bool> keep_{false};
};

} // namespace stipple
