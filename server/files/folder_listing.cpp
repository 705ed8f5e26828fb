#include "server/files/folder_listing.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <dirent.h>
#include <memory>
#include <sys/stat.h>

namespace stipple::server {

namespace {

constexpr std::chrono::seconds coarsestTick{2};
constexpr std::int64_t absent = -1;

std::int64_t changeTimeNs(const std::string& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0)
        return absent;
    return static_cast<std::int64_t>(status.st_mtim.tv_sec) * 1'000'000'000 + status.st_mtim.tv_nsec;
}

bool isWanted(const dirent& entry, const std::string& suffix) {
    std::string_view name = entry.d_name;
    bool mayBeFile = entry.d_type == DT_REG || entry.d_type == DT_LNK || entry.d_type == DT_UNKNOWN;
    return mayBeFile && !name.starts_with('.') && name.ends_with(suffix);
}

} // namespace

bool FolderListing::refresh() {
    auto now = std::chrono::system_clock::now();
    std::int64_t changedNs = changeTimeNs(path_);
    if (isKnown_ && changedNs == changedNs_) {
        auto readAtNs = std::chrono::duration_cast<std::chrono::nanoseconds>(readAt_.time_since_epoch());
        bool isSettled = readAtNs.count() - changedNs > std::chrono::nanoseconds(coarsestTick).count();
        bool isPausing = now >= readAt_ && now - readAt_ < rereadPause;
        if (isSettled || isPausing || changedNs == absent)
            return false;
    }
    changedNs_ = changedNs;
    readAt_ = now;
    auto names = read();
    bool isGone = !names && names.error().code == ErrorCode::notFound;
    status_ = names ? Status() : Status(names.error());
    isKnown_ = names || isGone;
    if (!isKnown_)
        return false;
    names_ = names ? std::move(*names) : std::vector<std::string>();
    return true;
}

Result<std::vector<std::string>> FolderListing::read() const {
    auto failed = [&] {
        bool isGone = errno == ENOENT || errno == ENOTDIR;
        return Error{isGone ? ErrorCode::notFound : ErrorCode::ioFailed,
                     cat("the folder can't be read: ", std::strerror(errno)), path_, ""};
    };
    std::unique_ptr<DIR, int (*)(DIR*)> folder(::opendir(path_.c_str()), ::closedir);
    if (!folder)
        return failed();
    std::vector<std::string> names;
    for (errno = 0; const dirent* entry = ::readdir(folder.get()); errno = 0)
        if (isWanted(*entry, suffix_))
            names.emplace_back(entry->d_name);
    if (errno != 0)
        return failed();
    std::sort(names.begin(), names.end());
    return names;
}

} // namespace stipple::server
