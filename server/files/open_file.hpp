// A regular file held open for serving, and what identifies the version that was opened. A file that is
// replaced (renamed over) stays readable here to the end; one that is changed in place is noticed by
// isUnchanged(). Thread: any; const after opening.
#pragma once

#include "shared/base/result.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace stipple::server {

struct FileIdentity {
    std::uint64_t sizeBytes = 0;
    std::int64_t modifiedNs = 0; // since 1970
    std::uint64_t inode = 0, device = 0;
    friend bool operator==(const FileIdentity&, const FileIdentity&) = default;

    // Strong entity tag: size, nanoseconds and inode. Two versions share one only if they are written in
    // place, with the same size, within one tick of the file system's clock.
    std::string entityTag() const;
    std::int64_t modifiedSeconds() const; // rounded down
};

class OpenFile {
  public:
    // Does not wait for a FIFO's writer. Errors: notFound; limitExceeded (no descriptor left); ioFailed;
    // invalidArgument for anything but a regular file.
    static Result<std::shared_ptr<const OpenFile>> open(const std::string& path);
    // Takes over `descriptor`, also when it fails. `name` is for messages.
    static Result<std::shared_ptr<const OpenFile>> adopt(int descriptor, const std::string& name);
    ~OpenFile();
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    const FileIdentity& identity() const { return identity_; }
    int descriptor() const { return descriptor_; }

    // False once the opened bytes may no longer be those of identity(): shorter, longer or written to.
    bool isUnchanged() const;
    // Reads all of [offset, offset + size) into `to`; false if the file ends earlier or can't be read.
    bool readAt(std::uint64_t offset, void* to, std::size_t size) const;

  private:
    OpenFile(int descriptor, FileIdentity identity) : descriptor_(descriptor), identity_(identity) {}
    int descriptor_;
    FileIdentity identity_;
};

// Identity of what `path` names now, without opening it. Errors: notFound, ioFailed.
Result<FileIdentity> identityOf(const std::string& path);

// The error for a failed open(2), by errno.
Error openError(int number, const std::string& name);

} // namespace stipple::server
