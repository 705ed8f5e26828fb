// Where the chunks of a LAZ file lie, made once when it is opened: of the chunk table, or, where that is
// missing or damaged, of what the chunks themselves say. Readers of one file share it.
#pragma once

#include "shared/io/byte_source.hpp"
#include "shared/las/laz/laszip_record.hpp"

namespace stipple::las::laz {

struct ChunkIndex {
    LaszipRecord record;
    std::size_t recordLength = 0;
    std::uint64_t pointCount = 0; // that the chunks have room for, at most what the header counts
    // First point and first byte of each chunk; one more closes the last. Memory: 16 bytes a chunk, which
    // takes more than that in the file.
    std::vector<std::uint64_t> starts, offsets;
    // No table, and chunks that do not say where they end: only the first can be entered. `starts` and
    // `offsets` then show one chunk from the first point to the last.
    bool sequential = false;
};

// Reads the LASzip record and the chunk table of a file whose points lie before `pointsEnd`. Cost: two or
// three small reads and about 0.1 µs a chunk. Errors: corrupt, truncated, unsupported, those of the source.
// What could be worked around becomes a warning.
Result<ChunkIndex> readChunkIndex(ByteSource& source, const Header& header, std::uint64_t pointsEnd,
                                  std::vector<std::string>& warnings);

} // namespace stipple::las::laz
