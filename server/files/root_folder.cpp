#include "server/files/root_folder.hpp"

#include <cerrno>
#include <fcntl.h>
#include <linux/openat2.h>
#include <string_view>
#include <sys/syscall.h>
#include <unistd.h>

namespace stipple::server {

namespace {

constexpr int fileFlags = O_RDONLY | O_CLOEXEC | O_NONBLOCK;

// Segment by segment without following any link: what is left without openat2.
int openWithoutLinks(int folder, std::string_view path) {
    int at = ::dup(folder);
    while (at >= 0) {
        std::size_t slash = path.find('/');
        bool isLast = slash == std::string_view::npos;
        std::string segment(path.substr(0, slash));
        int next = ::openat(at, segment.c_str(),
                            O_NOFOLLOW | (isLast ? fileFlags : O_PATH | O_DIRECTORY | O_CLOEXEC));
        int problem = errno;
        ::close(at);
        errno = problem;
        if (isLast || next < 0)
            return next;
        at = next;
        path.remove_prefix(slash + 1);
    }
    return at;
}

int openBeneath(int folder, const std::string& path) {
    struct open_how how {};
    how.flags = static_cast<std::uint64_t>(fileFlags);
    how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS;
    long descriptor = ::syscall(SYS_openat2, folder, path.c_str(), &how, sizeof how);
    if (descriptor < 0 && (errno == ENOSYS || errno == EPERM))
        return openWithoutLinks(folder, path);
    return static_cast<int>(descriptor);
}

bool hasHiddenSegment(std::string_view path) {
    return path.starts_with('.') || path.find("/.") != std::string_view::npos;
}

} // namespace

Result<std::unique_ptr<RootFolder>> RootFolder::open(const std::string& path) {
    int descriptor = ::open(path.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0 && errno == ENOTDIR)
        return Error{ErrorCode::invalidArgument, "is not a folder", path, ""};
    if (descriptor < 0)
        return openError(errno, path);
    return std::unique_ptr<RootFolder>(new RootFolder(descriptor));
}

RootFolder::~RootFolder() {
    ::close(descriptor_);
}

Result<std::shared_ptr<const OpenFile>> RootFolder::openFile(const std::string& relativePath) const {
    Error missing{ErrorCode::notFound, "there is no such file", relativePath, ""};
    if (relativePath.empty() || relativePath.front() == '/' || hasHiddenSegment(relativePath))
        return missing;
    int descriptor = openBeneath(descriptor_, relativePath);
    // EXDEV: the path leads out of the folder. ELOOP: a link where none is followed.
    if (descriptor < 0 && (errno == EXDEV || errno == ELOOP || errno == ENAMETOOLONG))
        return missing;
    if (descriptor < 0)
        return openError(errno, relativePath);
    return OpenFile::adopt(descriptor, relativePath);
}

} // namespace stipple::server
