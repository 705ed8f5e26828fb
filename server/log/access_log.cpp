#include "server/log/access_log.hpp"

#include "shared/base/text.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

namespace stipple::server {

Result<std::unique_ptr<AccessLog>> AccessLog::open(LogFormat format, const std::string& path) {
    std::unique_ptr<AccessLog> log(new AccessLog(format, path));
    if (path.empty())
        return log;
    STIPPLE_TRY(descriptor, log->openFile());
    log->descriptor_ = descriptor;
    return log;
}

AccessLog::~AccessLog() {
    if (!path_.empty())
        ::close(descriptor_);
}

Result<int> AccessLog::openFile() const {
    int descriptor = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0640);
    if (descriptor < 0)
        return Error{ErrorCode::writeFailed, cat("can't be opened: ", std::strerror(errno)), path_, ""};
    return descriptor;
}

// One write a line: with O_APPEND, lines of several programs do not mix.
void AccessLog::write(const RequestRecord& record) {
    std::string line = (format_ == LogFormat::json ? jsonLine(record) : combinedLine(record)) + "\n";
    std::lock_guard lock(mutex_);
    for (std::string_view rest = line; !rest.empty();) {
        ssize_t written = ::write(descriptor_, rest.data(), rest.size());
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return;
        rest.remove_prefix(static_cast<std::size_t>(written));
    }
}

Status AccessLog::reopen() {
    if (path_.empty())
        return {};
    STIPPLE_TRY(descriptor, openFile());
    std::lock_guard lock(mutex_);
    ::close(descriptor_);
    descriptor_ = descriptor;
    return {};
}

} // namespace stipple::server
