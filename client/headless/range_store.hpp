// Bytes of clouds at servers, kept in a folder beyond the end of the program. Each version of a cloud
// (address, strong ETag and size) has two files:
//
//   NAME.bytes    the file's bytes at their places; a sparse file, what was never fetched is a hole
//   NAME.ranges   "STIPRNG1", u32 bytes of the key, the key; then for each piece of at most 64 KiB: u64
//                 offset, u64 size, u64 XXH64 of its bytes, u64 XXH64 of the three; all little-endian
//
// A piece is listed after its bytes are written, and compared with its checksum when it is read, so what a
// killed program left, or a disk damaged, is not served but fetched again. What the disk refuses is done
// without. A version is used by one program at a time; another one does without it. Bounded in bytes: whole
// versions go, the least recently opened first; files that are not ours are left alone.
//
// Thread: one. Memory: 24 bytes a piece.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"
#include "shared/io/byte_source.hpp"
#include "shared/io/range_answer.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace stipple {

// One version.
class StoredRanges {
  public:
    ~StoredRanges();
    StoredRanges(const StoredRanges&) = delete;
    StoredRanges& operator=(const StoredRanges&) = delete;

    // How many bytes from range.offset on are here and whole, at most range.size; appended to `to`.
    std::uint64_t readHead(ByteRange range, Bytes& to);
    // Likewise from the end of the range backwards; put before `to`.
    std::uint64_t readTail(ByteRange range, Bytes& to);
    // Keeps what is not there yet, unless there is no room.
    void keep(std::uint64_t offset, ByteSpan bytes);

  private:
    friend class RangeStore;
    struct Piece {
        std::uint64_t size = 0, checksum = 0;
    };
    using Pieces = std::map<std::uint64_t, Piece>; // by offset
    StoredRanges(int bytes, int ranges, std::uint64_t room) : bytes_(bytes), ranges_(ranges), room_(room) {}
    void takeOver(std::uint64_t listOffset);
    Pieces::iterator pieceAt(std::uint64_t offset);
    // The bytes of a piece; one that is damaged is forgotten.
    std::optional<Bytes> read(Pieces::iterator piece);
    bool keepPiece(std::uint64_t offset, ByteSpan bytes);

    const int bytes_, ranges_; // descriptors
    std::uint64_t room_;       // bytes that may be added
    std::uint64_t listEnd_ = 0;
    Pieces pieces_;
};

class RangeStore {
  public:
    // Makes the folder if it is not there. Errors: writeFailed.
    static Result<std::shared_ptr<RangeStore>> open(const std::string& folder, std::uint64_t maxBytes);

    // What is here of that version, and where more of it goes; null if it has no strong ETag, another program
    // uses it, or the disk refuses.
    std::unique_ptr<StoredRanges> version(const std::string& url, const FileVersion& version);

  private:
    RangeStore(std::string folder, std::uint64_t maxBytes)
        : folder_(std::move(folder)), maxBytes_(maxBytes) {}
    std::uint64_t makeRoom(const std::string& keptName);

    const std::string folder_;
    const std::uint64_t maxBytes_;
};

} // namespace stipple
