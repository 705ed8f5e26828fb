#include "shared/io/file_writing.hpp"

#include "shared/base/text.hpp"

#include <cerrno>
#include <cstring>
#include <unistd.h>

namespace stipple {

bool writeFully(int descriptor, std::uint64_t offset, ByteSpan bytes) {
    while (!bytes.empty()) {
        ssize_t part = ::pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (part < 0 && errno == EINTR)
            continue;
        if (part == 0)
            errno = EIO; // nothing said why
        if (part <= 0)
            return false;
        bytes = bytes.subspan(static_cast<std::size_t>(part));
        offset += static_cast<std::uint64_t>(part);
    }
    return true;
}

Error writeFailure(const char* what, const std::string& path, const char* whereElse) {
    const int code = errno;
    Error error{ErrorCode::writeFailed, cat(what, ": ", std::strerror(code)), path, ""};
    if (code == ENOSPC || code == EDQUOT)
        error.advice = cat("free space on that disk, or ", whereElse);
    if (code == EFBIG)
        error.advice = "raise the limit on the size of files (ulimit -f)";
    return error;
}

} // namespace stipple
