// The chunk table: how many bytes (and, where that varies, points) each chunk has. A file with chunks begins
// its points with the table's offset, i64; the table lies behind the chunks.
//
//   0 version u32 (0)   4 chunk count u32   8 arithmetic stream: of each chunk [points,] bytes, each an
//                                             integer predicted by that of the chunk before
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <vector>

namespace stipple::las::laz {

struct Chunk {
    std::uint32_t points = 0; // only where the number varies
    std::uint32_t bytes = 0;
    friend bool operator==(const Chunk&, const Chunk&) = default;
};

inline constexpr std::size_t chunkTableHeadSize = 8;

// `bytes` begin with the table and may go on behind it. Errors: truncated, corrupt, unsupported (version);
// corrupt if there are more than `mostChunks`, which also bounds the memory.
Result<std::vector<Chunk>> parseChunkTable(ByteSpan bytes, bool variable, std::uint64_t mostChunks);

Bytes encodeChunkTable(const std::vector<Chunk>& chunks, bool variable);

} // namespace stipple::las::laz
