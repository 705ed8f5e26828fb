// The record "laszip encoded" 22204: how the points of a LAZ file are compressed.
//
//   0 compressor u16   4 version major, minor u8   8 options u32      16 special EVLRs i64, their offset i64
//   2 coder u16        6 revision u16             12 chunk size u32   32 item count u16, then of each
//                                                                     type, size, version u16
#pragma once

#include "shared/las/las_header.hpp"
#include "shared/las/laz/chunk_codec.hpp"

namespace stipple::las::laz {

enum class Compressor : std::uint16_t {
    pointwise = 1, // one stream for all points
    pointwiseChunked = 2,
    layeredChunked = 3,
};

inline constexpr std::uint32_t variableChunkSize = 0xFFFFFFFFu; // the chunk table says how many points
inline constexpr std::uint32_t defaultChunkSize = 50000;

struct LaszipRecord {
    Compressor compressor = Compressor::pointwiseChunked;
    std::uint8_t versionMajor = 3, versionMinor = 4; // of the LASzip whose output this is like
    std::uint16_t versionRevision = 3;
    std::uint32_t options = 0;
    std::uint32_t chunkSize = defaultChunkSize;
    Items items;

    bool isChunked() const { return compressor >= Compressor::pointwiseChunked; }
    bool hasVariableChunks() const { return isChunked() && chunkSize == variableChunkSize; }
};

// Errors: corrupt where it contradicts itself, the point format or the record length; unsupported for coders,
// compressors, items and versions that are not known.
Result<LaszipRecord> parseLaszipRecord(ByteSpan data, int pointFormat, std::size_t recordLength);
Bytes encodeLaszipRecord(const LaszipRecord& record);

// What files of a point format are written with: pointwise version 2 up to format 5, layered version 3 from 6
// on.
LaszipRecord laszipRecordFor(int pointFormat, std::size_t recordLength);

} // namespace stipple::las::laz
