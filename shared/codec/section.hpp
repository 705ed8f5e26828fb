// A section: a run of bytes inside a block, stored as they are or as one zstd frame.
//
//   varint  2 × stored bytes + (1 if compressed)
//   bytes   the content itself, or a zstd frame (RFC 8878) without its four magic bytes
//
// A section costs little to write when it does not compress, so codecs write all their parts as sections.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <vector>

namespace stipple {

// How hard to try. All of them make ordinary zstd frames, which decode at nearly the same speed.
enum class Effort {
    literals, // Huffman coding alone: bytes with a skewed distribution and no repeated strings
    fast,     // zstd's fast levels
    thorough, // for small or very repetitive content
};

// Writes `content` as a section, compressed if that is smaller. Thread: any.
void writeSection(ByteWriter& to, ByteSpan content, Effort effort);

// Reads a section into `room`, whose first bytes become its content; returns their number. Errors:
// truncated, corrupt, and corrupt if the content is larger than `room`.
Result<std::size_t> readSection(ByteReader& from, std::span<std::uint8_t> room);
// The same, for content that must fill `room` exactly.
Status readFullSection(ByteReader& from, std::span<std::uint8_t> room);

} // namespace stipple
