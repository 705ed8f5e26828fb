// Reading the variable length records of a LAS file, normal and extended.
#pragma once

#include "shared/io/byte_source.hpp"
#include "shared/las/header_block.hpp"

#include <string>
#include <vector>

namespace stipple::las {

// Records are loaded until together they take this much memory; later ones stay in the file (Vlr::omitted).
inline constexpr std::uint64_t maxLoadedRecordBytes = 256ull << 20;

// A file seen through one buffered window, for walking along small records. One thread.
class WindowReader {
  public:
    WindowReader(ByteSource& source, std::uint64_t fileBytes) : source_(source), fileBytes_(fileBytes) {}

    std::uint64_t fileBytes() const { return fileBytes_; }
    // Bytes [offset, offset + size), borrowed until the next call. truncated if the file ends before.
    Result<ByteSpan> at(std::uint64_t offset, std::uint64_t size);

  private:
    ByteSource& source_;
    std::uint64_t fileBytes_;
    std::uint64_t windowOffset_ = 0;
    Bytes window_;
};

struct RecordWalk {
    std::vector<Vlr>& vlrs;
    std::vector<std::string>& warnings;
    std::uint64_t loadedBytes = 0; // memory taken so far, the records' own included
};

// Appends `count` records from `offset` on; stops with a warning where the next would pass `end`. Returns
// the position after the last one. Errors: only those of the source.
Result<std::uint64_t> readVlrs(WindowReader& file, std::uint64_t offset, std::uint64_t count,
                               std::uint64_t end, bool extended, RecordWalk& walk);

} // namespace stipple::las
