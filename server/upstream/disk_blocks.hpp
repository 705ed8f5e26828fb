// Blocks of files at other servers that are kept on disk, beyond a restart. Bounded by bytes, the least
// recently used leave first. A block is a file of its own, written beside its place and renamed; it tells
// which block of which version it is and has a checksum, so one that is damaged or another's is dropped, not
// served. What the disk refuses is counted and done without. Thread: any.
//
//   FOLDER/stipple-blocks.lock   held while a server uses the folder
//   FOLDER/3f/3f0c….block        "STIPBLK1", u32 bytes of the key, u64 bytes of the block, u64 XXH64 of the
//   block,
//                                u64 XXH64 of key and sizes, the key, the block; all little-endian
#pragma once

#include "server/cache/shared_cache.hpp"
#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <atomic>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

namespace stipple::server {

class DiskBlocks {
  public:
    // Makes the folder if it is not there (readable by this user alone), and takes over what an earlier
    // server left in it. Errors: writeFailed; invalidArgument for a folder that holds other things, or that
    // another server uses.
    static Result<std::unique_ptr<DiskBlocks>> open(const std::string& folder, std::uint64_t maxBytes);
    ~DiskBlocks();
    DiskBlocks(const DiskBlocks&) = delete;
    DiskBlocks& operator=(const DiskBlocks&) = delete;

    // `key` names the version and the block, in any form. Nothing: it is not there, or was damaged and is
    // gone.
    std::optional<Bytes> find(const std::string& key);
    void keep(const std::string& key, ByteSpan block);

    CacheCounts counts() const;                          // bytes: of the files
    std::uint64_t damaged() const { return damaged_; }   // files dropped for what was in them
    std::uint64_t failures() const { return failures_; } // of the disk, to write

  private:
    DiskBlocks(std::string folder, std::uint64_t maxBytes, int lock)
        : folder_(std::move(folder)), maxBytes_(maxBytes), lock_(lock) {}
    struct Entry {
        std::string name; // "3f/3f0c….block"
        std::uint64_t bytes;
    };
    Status takeOver();
    std::string path(const std::string& name) const { return folder_ + "/" + name; }
    bool write(const std::string& name, ByteSpan head, ByteSpan block);
    void drop(const std::string& name);
    void makeRoomLocked();

    const std::string folder_;
    const std::uint64_t maxBytes_;
    const int lock_;
    mutable std::mutex mutex_;
    std::list<Entry> entries_; // most recently used first
    std::unordered_map<std::string, std::list<Entry>::iterator> places_;
    CacheCounts counts_;
    std::atomic<std::uint64_t> damaged_{0}, failures_{0}, written_{0};
};

} // namespace stipple::server
