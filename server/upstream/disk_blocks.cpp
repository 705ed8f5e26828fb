#include "server/upstream/disk_blocks.hpp"

#include "server/files/open_file.hpp"
#include "shared/base/text.hpp"
#include "shared/codec/checksum.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace stipple::server {

namespace {

namespace fs = std::filesystem;
constexpr const char* lockName = "stipple-blocks.lock";
constexpr std::string_view magic = "STIPBLK1", suffix = ".block";
constexpr std::size_t fixedBytes = 8 + 4 + 8 + 8 + 8;

ByteSpan bytesOf(std::string_view text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string nameOf(const std::string& key) {
    char text[40];
    std::snprintf(text, sizeof text, "%016llx%016llx",
                  static_cast<unsigned long long>(xxh64(bytesOf(key), 1)),
                  static_cast<unsigned long long>(xxh64(bytesOf(key), 2)));
    return cat(std::string_view(text, 2), "/", text, suffix);
}

Bytes headOf(const std::string& key, ByteSpan block) {
    ByteWriter head;
    head.writeBytes(bytesOf(magic));
    head.write(static_cast<std::uint32_t>(key.size()));
    head.write(static_cast<std::uint64_t>(block.size()));
    head.write(xxh64(block));
    head.write(xxh64(bytesOf(cat(key, "\n", key.size(), "\n", block.size()))));
    head.writeBytes(bytesOf(key));
    return head.take();
}

// The block in a file, if it is the one of `key` and whole.
std::optional<Bytes> blockIn(const Bytes& file, const std::string& key) {
    std::size_t before = fixedBytes + key.size();
    if (file.size() < before)
        return std::nullopt;
    Bytes block(file.begin() + static_cast<std::ptrdiff_t>(before), file.end());
    Bytes head = headOf(key, block);
    if (!std::equal(head.begin(), head.end(), file.begin()))
        return std::nullopt;
    return block;
}

bool writeAll(int descriptor, ByteSpan bytes) {
    while (!bytes.empty()) {
        ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            return false;
        bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
    return true;
}

bool isOurs(const std::string& name) {
    return name == lockName ||
           (name.size() == 2 && name.find_first_not_of("0123456789abcdef") == std::string::npos);
}

} // namespace

Result<std::unique_ptr<DiskBlocks>> DiskBlocks::open(const std::string& folder, std::uint64_t maxBytes) {
    std::error_code problem;
    if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
        return Error{ErrorCode::writeFailed, cat("can't be made: ", std::strerror(errno)), folder, ""};
    for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end;
         entry.increment(problem))
        if (!isOurs(entry->path().filename().string()))
            return Error{
                ErrorCode::invalidArgument,
                cat("holds \"", entry->path().filename().string(), "\", which is no block of a cloud"),
                folder, "give a folder of its own: what is in it is deleted when room is needed"};
    if (problem)
        return Error{ErrorCode::ioFailed, cat("can't be read: ", problem.message()), folder, ""};
    std::string lockPath = cat(folder, "/", lockName);
    int lock = ::open(lockPath.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (lock < 0)
        return Error{ErrorCode::writeFailed, cat("can't be written to: ", std::strerror(errno)), folder, ""};
    std::unique_ptr<DiskBlocks> blocks(new DiskBlocks(folder, maxBytes, lock));
    if (::flock(lock, LOCK_EX | LOCK_NB) != 0)
        return Error{ErrorCode::invalidArgument, "another server uses the folder", folder,
                     "give each server a folder of its own"};
    STIPPLE_CHECK(blocks->takeOver());
    return blocks;
}

DiskBlocks::~DiskBlocks() {
    ::close(lock_);
}

// What is there, most recently used first; what a killed server had not finished goes.
Status DiskBlocks::takeOver() {
    struct Found {
        Entry entry;
        fs::file_time_type usedAt;
    };
    std::vector<Found> found;
    std::error_code problem;
    for (fs::recursive_directory_iterator at(folder_, problem), end; !problem && at != end;
         at.increment(problem)) {
        std::error_code gone;
        if (!at->is_regular_file(gone) || at.depth() == 0)
            continue;
        std::string name = fs::path(at->path()).lexically_relative(folder_).string();
        if (!name.ends_with(suffix)) {
            fs::remove(at->path(), gone);
            continue;
        }
        std::uint64_t bytes = at->file_size(gone);
        auto usedAt = at->last_write_time(gone);
        if (!gone)
            found.push_back({{name, bytes}, usedAt});
    }
    if (problem)
        return Error{ErrorCode::ioFailed, cat("can't be read: ", problem.message()), folder_, ""};
    std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.usedAt > b.usedAt; });
    std::lock_guard lock(mutex_);
    for (Found& one : found) {
        counts_.bytes += one.entry.bytes;
        entries_.push_back(std::move(one.entry));
        places_[entries_.back().name] = std::prev(entries_.end());
    }
    makeRoomLocked();
    return {};
}

std::optional<Bytes> DiskBlocks::find(const std::string& key) {
    std::string name = nameOf(key);
    {
        std::lock_guard lock(mutex_);
        auto place = places_.find(name);
        if (place == places_.end()) {
            ++counts_.misses;
            return std::nullopt;
        }
        entries_.splice(entries_.begin(), entries_, place->second);
    }
    auto file = OpenFile::open(path(name));
    std::optional<Bytes> block;
    if (file) {
        Bytes bytes(static_cast<std::size_t>((*file)->identity().sizeBytes));
        if ((*file)->readAt(0, bytes.data(), bytes.size()))
            block = blockIn(bytes, key);
        ::futimens((*file)->descriptor(), nullptr); // used now, also for the next server
    }
    if (!block && (file || file.error().code == ErrorCode::notFound)) {
        damaged_ += file.ok() ? 1 : 0;
        drop(name);
    }
    std::lock_guard lock(mutex_);
    ++(block ? counts_.hits : counts_.misses);
    return block;
}

void DiskBlocks::keep(const std::string& key, ByteSpan block) {
    Bytes head = headOf(key, block);
    std::uint64_t bytes = head.size() + block.size();
    if (bytes > maxBytes_)
        return;
    std::string name = nameOf(key);
    if (!write(name, head, block)) {
        ++failures_;
        return;
    }
    std::lock_guard lock(mutex_);
    if (auto place = places_.find(name); place != places_.end()) { // replaced, or written twice at a time
        counts_.bytes -= place->second->bytes;
        entries_.erase(place->second);
    }
    entries_.push_front({name, bytes});
    places_[name] = entries_.begin();
    counts_.bytes += bytes;
    makeRoomLocked();
}

bool DiskBlocks::write(const std::string& name, ByteSpan head, ByteSpan block) {
    std::string to = path(name), fresh = cat(to, ".", ++written_, ".new");
    ::mkdir(path(name.substr(0, name.find('/'))).c_str(), 0700);
    int descriptor = ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (descriptor < 0)
        return false;
    bool isWritten = writeAll(descriptor, head) && writeAll(descriptor, block);
    isWritten = ::close(descriptor) == 0 && isWritten;
    isWritten = isWritten && ::rename(fresh.c_str(), to.c_str()) == 0;
    if (!isWritten)
        ::unlink(fresh.c_str());
    return isWritten;
}

void DiskBlocks::drop(const std::string& name) {
    std::lock_guard lock(mutex_);
    auto place = places_.find(name);
    if (place == places_.end())
        return;
    ::unlink(path(name).c_str());
    counts_.bytes -= place->second->bytes;
    entries_.erase(place->second);
    places_.erase(place);
}

void DiskBlocks::makeRoomLocked() {
    for (; counts_.bytes > maxBytes_; ++counts_.evicted) {
        const Entry& last = entries_.back();
        ::unlink(path(last.name).c_str());
        counts_.bytes -= last.bytes;
        places_.erase(last.name);
        entries_.pop_back();
    }
}

CacheCounts DiskBlocks::counts() const {
    std::lock_guard lock(mutex_);
    return counts_;
}

} // namespace stipple::server
