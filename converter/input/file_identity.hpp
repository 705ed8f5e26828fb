// Which file a path leads to.
#pragma once

#include <optional>
#include <string>
#include <sys/stat.h>
#include <utility>

namespace stipple {

// Device and inode: the same for every path, link and hard link of one file. Nothing where the path leads to
// no file that can be looked at.
using FileIdentity = std::pair<dev_t, ino_t>;
inline std::optional<FileIdentity> fileIdentity(const std::string& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0)
        return std::nullopt;
    return FileIdentity{status.st_dev, status.st_ino};
}

} // namespace stipple
