// The names in a folder, read anew only when they may have changed. Thread: one at a time.
#pragma once

#include "shared/base/result.hpp"

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace stipple::server {

class FolderListing {
  public:
    // Names that end in `suffix` and are not hidden; links count, subfolders do not.
    FolderListing(std::string path, std::string suffix)
        : path_(std::move(path)), suffix_(std::move(suffix)) {}

    // True if the names were read anew (which may give the same ones). Costs one stat(2) otherwise.
    //
    // A folder's time changes with its names, but in ticks of its file system (4 ms on Linux, up to 2 s
    // elsewhere): names that change again within the tick of the last reading leave no trace. So until a
    // folder's time is 2 s old it is read again, at most once in `rereadPause`.
    // A folder that is gone has no names; one that can't be read now (descriptors ran out) keeps those it
    // had.
    bool refresh();
    void readAgain() { isKnown_ = false; } // at the next refresh()

    const std::vector<std::string>& names() const { return names_; } // sorted
    const Status& status() const { return status_; }                 // of the last reading
    const std::string& path() const { return path_; }

    static constexpr std::chrono::milliseconds rereadPause{100};

  private:
    Result<std::vector<std::string>> read() const;

    std::string path_, suffix_;
    std::vector<std::string> names_;
    Status status_;
    bool isKnown_ = false;
    std::int64_t changedNs_ = 0; // the folder's time when it was read last
    std::chrono::system_clock::time_point readAt_;
};

} // namespace stipple::server
