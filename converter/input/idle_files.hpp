// Open files of an input that wait for their next stream. Opening one again reads headers, records and chunk
// tables again; but a process may hold only so many descriptors (often 1024), and an input may be one of
// thousands. So all inputs together keep at most maxIdleFiles, and an input that has been read through none.
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace stipple {

inline constexpr int maxIdleFiles = 64;

namespace detail {
inline std::atomic<int> idleFiles{0}; // of all inputs
}

// `File`: movable; closes when it goes. Thread: any.
template <class File>
class IdleFiles {
  public:
    IdleFiles() = default;
    ~IdleFiles() { detail::idleFiles -= static_cast<int>(files_.size()); }
    IdleFiles(const IdleFiles&) = delete;
    IdleFiles& operator=(const IdleFiles&) = delete;

    // Nothing if none waits: open one.
    std::optional<File> take() {
        std::lock_guard lock(mutex_);
        if (files_.empty())
            return std::nullopt;
        std::optional<File> file(std::move(files_.back()));
        files_.pop_back();
        --detail::idleFiles;
        return file;
    }

    // Keeps the file, or closes it where enough wait.
    void put(File file) {
        std::lock_guard lock(mutex_);
        if (++detail::idleFiles <= maxIdleFiles)
            files_.push_back(std::move(file));
        else
            --detail::idleFiles;
    }

    // As put(), after one of the `parts` of the input; after each `parts` of them all are closed.
    void putAfterPart(File file, std::size_t parts) {
        put(std::move(file));
        if (++partsRead_ % parts != 0)
            return;
        std::lock_guard lock(mutex_);
        detail::idleFiles -= static_cast<int>(files_.size());
        files_.clear();
    }

  private:
    std::mutex mutex_;
    std::vector<File> files_;
    std::atomic<std::size_t> partsRead_{0};
};

} // namespace stipple
