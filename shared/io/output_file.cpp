#include "shared/io/output_file.hpp"

#include "shared/base/text.hpp"
#include "shared/io/file_writing.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace stipple {

Result<std::unique_ptr<OutputFile>> OutputFile::create(const std::string& path) {
    struct stat existing {};
    if (::stat(path.c_str(), &existing) == 0 && !S_ISREG(existing.st_mode))
        return Error{ErrorCode::writeFailed, "can't be written: there is something that is no regular file",
                     path, "choose another name"};
    // A program that was killed may have left its temporary file: take the next free name.
    constexpr int attempts = 100;
    for (int i = 0; i < attempts; ++i) {
        std::string temporary = cat(path, ".part", i);
        int descriptor = ::open(temporary.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0)
            return std::unique_ptr<OutputFile>(new OutputFile(descriptor, path, temporary));
        if (errno != EEXIST)
            break;
    }
    return Error{ErrorCode::writeFailed, cat("can't be written: ", std::strerror(errno)), path, ""};
}

OutputFile::~OutputFile() {
    if (descriptor_ < 0)
        return;
    ::close(descriptor_);
    ::unlink(temporaryPath_.c_str());
}

Status OutputFile::append(ByteSpan bytes) {
    STIPPLE_CHECK(writeAt(size_, bytes));
    size_ += bytes.size();
    return {};
}

Status OutputFile::overwrite(std::uint64_t offset, ByteSpan bytes) {
    if (bytes.size() > size_ || offset > size_ - bytes.size())
        return Error{ErrorCode::invalidArgument, cat("bytes from ", offset, " on are not there to overwrite"),
                     path_, ""};
    return writeAt(offset, bytes);
}

Status OutputFile::writeAt(std::uint64_t offset, ByteSpan bytes) {
    if (!writeFully(descriptor_, offset, bytes))
        return failure("can't be written");
    return {};
}

Status OutputFile::commit() {
    int descriptor = std::exchange(descriptor_, -1);
    // Network file systems report a full disk only here.
    bool closed = ::close(descriptor) == 0;
    if (closed && std::rename(temporaryPath_.c_str(), path_.c_str()) == 0)
        return {};
    Error error = failure(closed ? "can't be given its name" : "can't be written");
    ::unlink(temporaryPath_.c_str());
    return error;
}

Error OutputFile::failure(const char* what) const {
    return writeFailure(what, path_, "write elsewhere");
}

} // namespace stipple
