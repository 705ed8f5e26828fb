// The outermost layer of an E57 file (ASTM E2807-11 §9.1, §9.2): pages of 1024 bytes whose last four are the
// CRC-32C of the 1020 before, most significant byte first. What lies in the pages, without the checksums, is
// the file's logical bytes; offsets in the file are physical (they count the checksums).
#pragma once

#include "shared/io/byte_source.hpp"

#include <span>
#include <vector>

namespace stipple::e57 {

inline constexpr std::uint64_t pageBytes = 1024;
inline constexpr std::uint64_t pagePayloadBytes = 1020;

// The 48 bytes at the file's start.
struct FileHeader {
    std::uint32_t versionMajor = 0, versionMinor = 0;
    std::uint64_t fileBytes = 0;    // physical; a multiple of the page's size, and not more than there are
    std::uint64_t xmlOffset = 0;    // physical
    std::uint64_t xmlBytes = 0;     // logical
    std::uint32_t pageChecksum = 0; // of the page that it is in
};
inline constexpr std::size_t fileHeaderBytes = 48;

// Checks the first page's checksum, the version, and that the file is all there.
Result<FileHeader> readFileHeader(ByteSource& source);

inline std::uint64_t physicalOffset(std::uint64_t logical) {
    return logical / pagePayloadBytes * pageBytes + logical % pagePayloadBytes;
}
// `corrupt` where the offset lies in a checksum or behind the file's end; `what` is at it.
Result<std::uint64_t> logicalOffset(std::uint64_t physical, const FileHeader& header, const char* what);

// "byte 1234": where a logical offset lies in the file, for messages.
std::string placeOf(std::uint64_t logical);

// Logical bytes of a file, each page checked as it comes from the disk. Keeps the blocks last used, so that
// several readers may walk through the same neighbourhood. Memory: blocks × pagesPerBlock pages.
// Thread: one. The source must outlive it.
class PagedFile {
  public:
    PagedFile(ByteSource& source, const FileHeader& header, std::size_t pagesPerBlock, std::size_t blocks)
        : source_(source), pageCount_(header.fileBytes / pageBytes), pagesPerBlock_(pagesPerBlock),
          blocks_(blocks) {}

    std::uint64_t sizeBytes() const { return pageCount_ * pagePayloadBytes; }
    // Fills `out` from `logical` on. Errors: `truncated` past the end; `corrupt` with page and byte where a
    // checksum is wrong; those of the source.
    Status read(std::uint64_t logical, std::span<std::uint8_t> out);

  private:
    struct Block {
        std::uint64_t number = ~std::uint64_t{0};
        std::uint64_t lastUse = 0;
        Bytes bytes; // logical
    };
    Result<const Block*> block(std::uint64_t number);

    ByteSource& source_;
    std::uint64_t pageCount_;
    std::uint64_t pagesPerBlock_;
    std::vector<Block> blocks_;
    std::uint64_t uses_ = 0;
};

} // namespace stipple::e57
