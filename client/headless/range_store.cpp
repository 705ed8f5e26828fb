#include "client/headless/range_store.hpp"

#include "shared/base/text.hpp"
#include "shared/codec/checksum.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <string_view>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace stipple {

namespace {

namespace fs = std::filesystem;
constexpr std::string_view magic = "STIPRNG1", bytesSuffix = ".bytes", rangesSuffix = ".ranges";
constexpr std::size_t pieceBytes = 64 << 10, recordBytes = 32, nameDigits = 32;

ByteSpan bytesOf(std::string_view text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string nameOf(const std::string& key) {
    char text[nameDigits + 1];
    std::snprintf(text, sizeof text, "%016llx%016llx",
                  static_cast<unsigned long long>(xxh64(bytesOf(key), 1)),
                  static_cast<unsigned long long>(xxh64(bytesOf(key), 2)));
    return text;
}

bool isOurs(const std::string& name, std::string_view suffix) {
    return name.size() == nameDigits + suffix.size() && name.ends_with(suffix) &&
           name.find_first_not_of("0123456789abcdef") == nameDigits;
}

bool writeAt(int descriptor, std::uint64_t offset, ByteSpan bytes) {
    while (!bytes.empty()) {
        ssize_t count = ::pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            return false;
        offset += static_cast<std::uint64_t>(count);
        bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
    return true;
}

bool readAt(int descriptor, std::uint64_t offset, std::uint8_t* to, std::size_t size) {
    while (size > 0) {
        ssize_t count = ::pread(descriptor, to, size, static_cast<off_t>(offset));
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            return false;
        offset += static_cast<std::uint64_t>(count);
        to += count;
        size -= static_cast<std::size_t>(count);
    }
    return true;
}

Bytes headOf(const std::string& key) {
    ByteWriter head;
    head.writeBytes(bytesOf(magic));
    head.write(static_cast<std::uint32_t>(key.size()));
    head.writeBytes(bytesOf(key));
    return head.take();
}

Bytes recordOf(std::uint64_t offset, std::uint64_t size, std::uint64_t checksum) {
    ByteWriter record;
    record.write(offset);
    record.write(size);
    record.write(checksum);
    Bytes three = record.take();
    ByteWriter guarded;
    guarded.writeBytes(three);
    guarded.write(xxh64(three));
    return guarded.take();
}

} // namespace

// --- one version ---------------------------------------------------------------------------------------

StoredRanges::~StoredRanges() {
    ::close(bytes_);
    ::close(ranges_);
}

// Records up to the first that is not whole: what a killed program was writing.
void StoredRanges::takeOver(std::uint64_t listOffset) {
    listEnd_ = listOffset;
    std::array<std::uint8_t, recordBytes> raw;
    while (readAt(ranges_, listEnd_, raw.data(), raw.size())) {
        auto offset = loadLe<std::uint64_t>(raw.data()), size = loadLe<std::uint64_t>(raw.data() + 8),
             checksum = loadLe<std::uint64_t>(raw.data() + 16);
        Bytes expected = recordOf(offset, size, checksum);
        if (size == 0 || size > pieceBytes || !std::equal(expected.begin(), expected.end(), raw.begin()))
            return;
        pieces_[offset] = {size, checksum};
        listEnd_ += recordBytes;
    }
}

StoredRanges::Pieces::iterator StoredRanges::pieceAt(std::uint64_t offset) {
    auto piece = pieces_.upper_bound(offset);
    if (piece == pieces_.begin())
        return pieces_.end();
    --piece;
    return offset - piece->first < piece->second.size ? piece : pieces_.end();
}

std::optional<Bytes> StoredRanges::read(Pieces::iterator piece) {
    Bytes bytes(static_cast<std::size_t>(piece->second.size));
    if (readAt(bytes_, piece->first, bytes.data(), bytes.size()) && xxh64(bytes) == piece->second.checksum)
        return bytes;
    pieces_.erase(piece);
    return std::nullopt;
}

std::uint64_t StoredRanges::readHead(ByteRange range, Bytes& to) {
    std::uint64_t here = 0;
    while (here < range.size) {
        auto piece = pieceAt(range.offset + here);
        if (piece == pieces_.end())
            break;
        std::uint64_t skip = range.offset + here - piece->first;
        auto bytes = read(piece);
        if (!bytes)
            break;
        std::uint64_t size = std::min(bytes->size() - skip, range.size - here);
        auto from = bytes->begin() + static_cast<std::ptrdiff_t>(skip);
        to.insert(to.end(), from, from + static_cast<std::ptrdiff_t>(size));
        here += size;
    }
    return here;
}

std::uint64_t StoredRanges::readTail(ByteRange range, Bytes& to) {
    std::uint64_t here = 0;
    while (here < range.size) {
        auto piece = pieceAt(range.end() - here - 1);
        if (piece == pieces_.end())
            break;
        std::uint64_t begin = std::max(piece->first, range.offset), skip = begin - piece->first;
        auto bytes = read(piece);
        if (!bytes)
            break;
        std::uint64_t size = range.end() - here - begin;
        auto from = bytes->begin() + static_cast<std::ptrdiff_t>(skip);
        to.insert(to.begin(), from, from + static_cast<std::ptrdiff_t>(size));
        here += size;
    }
    return here;
}

void StoredRanges::keep(std::uint64_t offset, ByteSpan bytes) {
    while (!bytes.empty()) {
        std::size_t size = std::min(bytes.size(), pieceBytes);
        if (auto piece = pieceAt(offset); piece != pieces_.end()) { // here already
            size = static_cast<std::size_t>(
                std::min<std::uint64_t>(bytes.size(), piece->first + piece->second.size - offset));
        } else {
            if (auto next = pieces_.lower_bound(offset); next != pieces_.end())
                size = static_cast<std::size_t>(std::min<std::uint64_t>(size, next->first - offset));
            if (!keepPiece(offset, bytes.first(size)))
                return;
        }
        offset += size;
        bytes = bytes.subspan(size);
    }
}

bool StoredRanges::keepPiece(std::uint64_t offset, ByteSpan bytes) {
    std::uint64_t checksum = xxh64(bytes), size = bytes.size();
    if (size + recordBytes > room_ || !writeAt(bytes_, offset, bytes) ||
        !writeAt(ranges_, listEnd_, recordOf(offset, size, checksum)))
        return false;
    room_ -= size + recordBytes;
    listEnd_ += recordBytes;
    pieces_[offset] = {size, checksum};
    return true;
}

// --- the folder ----------------------------------------------------------------------------------------

Result<std::shared_ptr<RangeStore>> RangeStore::open(const std::string& folder, std::uint64_t maxBytes) {
    if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
        return Error{ErrorCode::writeFailed, cat("can't be made: ", std::strerror(errno)), folder,
                     "name a folder that exists, or one that can be made"};
    if (::access(folder.c_str(), R_OK | W_OK | X_OK) != 0 || !fs::is_directory(folder))
        return Error{ErrorCode::writeFailed, "can't be used as a folder for bytes of clouds", folder,
                     "name a folder that you may write to"};
    return std::shared_ptr<RangeStore>(new RangeStore(folder, maxBytes));
}

std::unique_ptr<StoredRanges> RangeStore::version(const std::string& url, const FileVersion& version) {
    if (!version.etag.starts_with('"') || version.sizeBytes == 0) // weak tags don't tell for certain
        return nullptr;
    std::string key = cat(url, "\n", version.etag, "\n", version.sizeBytes), name = nameOf(key);
    std::uint64_t room = makeRoom(name);
    std::string path = cat(folder_, "/", name);
    int ranges = ::open(cat(path, rangesSuffix).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    int bytes = ::open(cat(path, bytesSuffix).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (ranges < 0 || bytes < 0 || ::flock(ranges, LOCK_EX | LOCK_NB) != 0) {
        for (int descriptor : {ranges, bytes})
            if (descriptor >= 0)
                ::close(descriptor);
        return nullptr;
    }
    ::futimens(ranges, nullptr); // used now
    std::unique_ptr<StoredRanges> stored(new StoredRanges(bytes, ranges, room));
    Bytes head = headOf(key), there(head.size());
    bool isOurs = readAt(ranges, 0, there.data(), there.size()) && there == head;
    if (!isOurs && (::ftruncate(ranges, 0) != 0 || !writeAt(ranges, 0, head)))
        return nullptr;
    stored->takeOver(head.size());
    return stored;
}

// Deletes versions, the least recently opened first, until half of the limit is free beside `keptName`, and
// answers how much may be added to that.
std::uint64_t RangeStore::makeRoom(const std::string& keptName) {
    struct Found {
        std::string name;
        std::uint64_t bytes = 0;
        struct timespec usedAt {};
    };
    std::vector<Found> found;
    std::uint64_t all = 0, kept = 0;
    std::error_code problem;
    for (fs::directory_iterator at(folder_, problem), end; !problem && at != end; at.increment(problem)) {
        std::string file = at->path().filename().string();
        if (!isOurs(file, rangesSuffix))
            continue;
        Found one{file.substr(0, nameDigits), 0, {}};
        struct stat state {};
        for (std::string_view suffix : {bytesSuffix, rangesSuffix})
            if (::stat(cat(folder_, "/", one.name, suffix).c_str(), &state) == 0)
                one.bytes += static_cast<std::uint64_t>(state.st_blocks) * 512; // without holes
        one.usedAt = state.st_mtim;
        all += one.bytes;
        if (one.name == keptName)
            kept = one.bytes;
        else
            found.push_back(std::move(one));
    }
    std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
        return std::tie(a.usedAt.tv_sec, a.usedAt.tv_nsec) < std::tie(b.usedAt.tv_sec, b.usedAt.tv_nsec);
    });
    for (const Found& one : found) {
        if (all - kept <= maxBytes_ / 2)
            break;
        std::string path = cat(folder_, "/", one.name);
        int ranges = ::open(cat(path, rangesSuffix).c_str(), O_RDWR | O_CLOEXEC);
        if (ranges >= 0 && ::flock(ranges, LOCK_EX | LOCK_NB) == 0) { // nobody uses it
            ::unlink(cat(path, bytesSuffix).c_str());
            ::unlink(cat(path, rangesSuffix).c_str());
            all -= one.bytes;
        }
        if (ranges >= 0)
            ::close(ranges);
    }
    return maxBytes_ > all ? maxBytes_ - all : 0;
}

} // namespace stipple
