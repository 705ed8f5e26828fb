#include "shared/io/scratch_file.hpp"

#include "shared/base/text.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace stipple {

Result<std::unique_ptr<ScratchFile>> ScratchFile::create(const std::string& path) {
    int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0)
        return Error{ErrorCode::writeFailed, cat("can't be created: ", std::strerror(errno)), path,
                     "choose another folder for temporary files"};
    return std::unique_ptr<ScratchFile>(new ScratchFile(descriptor, path, 0));
}

Result<std::unique_ptr<ScratchFile>> ScratchFile::open(const std::string& path) {
    int descriptor = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
    if (descriptor < 0)
        return Error{errno == ENOENT ? ErrorCode::notFound : ErrorCode::ioFailed,
                     cat("can't be opened: ", std::strerror(errno)), path, ""};
    struct stat status {};
    std::uint64_t size = ::fstat(descriptor, &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
    return std::unique_ptr<ScratchFile>(new ScratchFile(descriptor, path, size));
}

ScratchFile::~ScratchFile() {
    ::close(descriptor_);
    if (!keep_)
        ::unlink(path_.c_str());
}

Status ScratchFile::write(std::uint64_t offset, ByteSpan bytes) {
    while (!bytes.empty()) {
        ssize_t part = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (part < 0 && errno == EINTR)
            continue;
        if (part <= 0)
            return failure("can't be written");
        bytes = bytes.subspan(static_cast<std::size_t>(part));
        offset += static_cast<std::uint64_t>(part);
    }
    return {};
}

Status ScratchFile::read(std::uint64_t offset, std::span<std::uint8_t> to) const {
    while (!to.empty()) {
        ssize_t part = ::pread(descriptor_, to.data(), to.size(), static_cast<off_t>(offset));
        if (part < 0 && errno == EINTR)
            continue;
        if (part == 0)
            return Error{ErrorCode::truncated, cat("ends before byte ", offset), path_,
                         "somebody changed this temporary file; start again"};
        if (part < 0)
            return failure("can't be read back");
        to = to.subspan(static_cast<std::size_t>(part));
        offset += static_cast<std::uint64_t>(part);
    }
    return {};
}

void ScratchFile::discard(std::uint64_t offset, std::uint64_t size) {
#if defined(__linux__) && defined(FALLOC_FL_PUNCH_HOLE)
    // Only a saving: a file system that can't keeps the bytes.
    (void)::fallocate(descriptor_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, static_cast<off_t>(offset),
                      static_cast<off_t>(size));
#else
    (void)offset;
    (void)size;
#endif
}

Error ScratchFile::failure(const char* what) const {
    int code = errno;
    return {ErrorCode::writeFailed, cat(what, ": ", std::strerror(code)), path_,
            code == ENOSPC || code == EDQUOT ? "free space on that disk, or choose another folder"
            : code == EFBIG                  ? "raise the limit on the size of files (ulimit -f)"
                                             : ""};
}

} // namespace stipple
