#include "shared/io/scratch_file.hpp"

#include "shared/base/text.hpp"
#include "shared/io/file_writing.hpp"

#include <cerrno>
#include <cstdlib>
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

Result<std::unique_ptr<ScratchFile>> ScratchFile::createNameless(const std::string& folder) {
    int descriptor = -1;
#ifdef O_TMPFILE
    descriptor = ::open(folder.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0600);
#endif
    if (descriptor < 0) { // a file system that knows no files without a name
        std::string path = cat(folder, "/stipple-XXXXXX");
        descriptor = ::mkstemp(path.data());
        if (descriptor >= 0)
            ::unlink(path.c_str());
    }
    if (descriptor < 0)
        return Error{ErrorCode::writeFailed, cat("no file can be created there: ", std::strerror(errno)),
                     folder, "choose another folder for temporary files"};
    std::unique_ptr<ScratchFile> file(new ScratchFile(descriptor, folder, 0));
    file->keep(); // there is no name to remove
    return file;
}

ScratchFile::~ScratchFile() {
    ::close(descriptor_);
    if (!keep_)
        ::unlink(path_.c_str());
}

Status ScratchFile::write(std::uint64_t offset, ByteSpan bytes) {
    if (!writeFully(descriptor_, offset, bytes))
        return failure("can't be written");
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
    return writeFailure(what, path_, "choose another folder");
}

} // namespace stipple
