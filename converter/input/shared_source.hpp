// One file for several threads: reads are answered one after the other. All readers see the same version of
// the file; a change is the error `changed`.
#pragma once

#include "shared/io/byte_source.hpp"

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>

namespace stipple {

class SharedSource {
  public:
    explicit SharedSource(std::unique_ptr<ByteSource> source)
        : source_(std::move(source)), sizeBytes_(source_->sizeBytes()), name_(source_->name()) {}
    // A file that can be let go and opened again (input_file.hpp).
    static Result<std::unique_ptr<SharedSource>> openFile(const std::string& path,
                                                          const std::atomic<bool>* stop = nullptr);

    // As ByteSource::read, waited for; no bytes, and no error, from the end of the file on.
    Result<Bytes> read(ByteRange range);
    // Closes a file until the next read: an input may be one of thousands, and descriptors are few.
    void rest();

    std::uint64_t sizeBytes() const { return sizeBytes_; }
    const std::string& name() const { return name_; }

  private:
    Status open();

    std::mutex mutex_;
    std::unique_ptr<ByteSource> source_; // null: resting
    std::uint64_t sizeBytes_ = 0;
    std::string name_;
    bool isFile_ = false;
    const std::atomic<bool>* stop_ = nullptr;
    std::filesystem::file_time_type changed_; // of files
};

} // namespace stipple
