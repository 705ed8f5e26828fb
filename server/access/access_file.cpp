#include "server/access/access_rules.hpp"
#include "server/files/open_file.hpp"
#include "shared/base/text.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace stipple::server {

namespace {

constexpr std::uint64_t maxAccessFileBytes = 16 << 20;

Error writeError(const std::string& path) {
    return {ErrorCode::writeFailed, cat("can't be written: ", std::strerror(errno)), path, ""};
}

// What the group could do with the file before, it still can; other users can't.
void keepGroup(int descriptor, const std::string& path) {
    struct stat before {};
    if (::stat(path.c_str(), &before) != 0)
        return;
    bool isKept = ::fchown(descriptor, before.st_uid, before.st_gid) == 0;
    ::fchmod(descriptor, before.st_mode & (isKept ? 0770 : 0700));
}

bool writeAll(int descriptor, std::string_view text) {
    while (!text.empty()) {
        ssize_t written = ::write(descriptor, text.data(), text.size());
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return false;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

} // namespace

Result<AccessRules> readAccessFile(const std::string& path) {
    STIPPLE_TRY(file, OpenFile::open(path));
    struct stat status {};
    if (::fstat(file->descriptor(), &status) == 0 && (status.st_mode & S_IROTH) != 0)
        return Error{ErrorCode::invalidArgument, "every user of this machine can read its secrets", path,
                     "chmod o= on it"};
    if (file->identity().sizeBytes > maxAccessFileBytes)
        return Error{ErrorCode::limitExceeded, "is larger than 16 MiB", path, ""};
    std::string text(static_cast<std::size_t>(file->identity().sizeBytes), '\0');
    if (!file->readAt(0, text.data(), text.size()))
        return Error{ErrorCode::ioFailed, "can't be read", path, ""};
    auto rules = parseAccessRules(text);
    if (!rules)
        return rules.error().at(path);
    return rules;
}

Status writeAccessFile(const std::string& path, const AccessRules& rules) {
    std::string fresh = cat(path, ".new");
    ::unlink(fresh.c_str()); // one that a killed run left; opening it would keep its mode
    int descriptor = ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (descriptor < 0)
        return writeError(fresh);
    keepGroup(descriptor, path);
    bool isWritten = writeAll(descriptor, accessRulesText(rules)) && ::fsync(descriptor) == 0;
    isWritten = ::close(descriptor) == 0 && isWritten;
    if (isWritten && ::rename(fresh.c_str(), path.c_str()) == 0)
        return {};
    Error error = writeError(path);
    ::unlink(fresh.c_str());
    return error;
}

} // namespace stipple::server
