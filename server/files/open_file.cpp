#include "server/files/open_file.hpp"

#include "shared/base/text.hpp"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace stipple::server {

namespace {
FileIdentity identityFrom(const struct stat& status) {
    return {static_cast<std::uint64_t>(status.st_size),
            static_cast<std::int64_t>(status.st_mtim.tv_sec) * 1'000'000'000 + status.st_mtim.tv_nsec,
            static_cast<std::uint64_t>(status.st_ino), static_cast<std::uint64_t>(status.st_dev)};
}
} // namespace

std::string FileIdentity::entityTag() const {
    char tag[64] = "\"";
    char* at = tag + 1;
    for (std::uint64_t number : {sizeBytes, static_cast<std::uint64_t>(modifiedNs), inode}) {
        at = std::to_chars(at, tag + sizeof tag, number, 16).ptr;
        *at++ = '-';
    }
    at[-1] = '"';
    return {tag, at};
}

std::int64_t FileIdentity::modifiedSeconds() const {
    return modifiedNs / 1'000'000'000 - (modifiedNs % 1'000'000'000 < 0 ? 1 : 0);
}

Error openError(int number, const std::string& name) {
    switch (number) {
    case ENOENT:
    case ENOTDIR:
        return {ErrorCode::notFound, "there is no such file", name, ""};
    case EMFILE:
    case ENFILE:
        return {ErrorCode::limitExceeded, "too many files are open", name, "try again in a moment"};
    default:
        return {ErrorCode::ioFailed, cat("can't be opened: ", std::strerror(number)), name, ""};
    }
}

Result<std::shared_ptr<const OpenFile>> OpenFile::open(const std::string& path) {
    int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0)
        return openError(errno, path);
    return adopt(descriptor, path);
}

Result<std::shared_ptr<const OpenFile>> OpenFile::adopt(int descriptor, const std::string& name) {
    struct stat status {};
    if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
        ::close(descriptor);
        return Error{ErrorCode::invalidArgument, "is not a regular file", name, ""};
    }
    return std::shared_ptr<const OpenFile>(new OpenFile(descriptor, identityFrom(status)));
}

OpenFile::~OpenFile() {
    ::close(descriptor_);
}

bool OpenFile::isUnchanged() const {
    struct stat status {};
    return ::fstat(descriptor_, &status) == 0 && identityFrom(status) == identity_;
}

bool OpenFile::readAt(std::uint64_t offset, void* to, std::size_t size) const {
    auto* at = static_cast<std::uint8_t*>(to);
    while (size > 0) {
        ssize_t got = ::pread(descriptor_, at, size, static_cast<off_t>(offset));
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        at += got;
        offset += static_cast<std::uint64_t>(got);
        size -= static_cast<std::size_t>(got);
    }
    return true;
}

Result<FileIdentity> identityOf(const std::string& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0)
        return openError(errno, path);
    return identityFrom(status);
}

} // namespace stipple::server
