// The Range field (RFC 9110 §14.1, §14.2) applied to a representation of known size. Pure arithmetic in
// 64 bits that never wraps: numbers too large for 64 bits are larger than any file.
#pragma once

#include "shared/io/byte_source.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace stipple::server {

inline constexpr std::size_t maxRangesInRequest = 64;
// Asked-for ranges nearer to each other than this are sent as one part: about what a part's header costs.
inline constexpr std::uint64_t rangeMergeGapBytes = 128;
// A range that means nothing is ignored for small files, as most servers do, but refused for larger ones: a
// typing error must not start a download of 40 GB. RFC 9110 §14.2 allows both.
inline constexpr std::uint64_t ignoreBadRangeUpToBytes = 1 << 20;

enum class RangeAnswerKind {
    whole,         // no Range, another unit, or a meaningless range on a small file: 200
    parts,         // 206; at least one part
    unsatisfiable, // 416: nothing of the file lies in the ranges
    refused,       // 416: malformed, or more than maxRangesInRequest
};

struct ResolvedRanges {
    RangeAnswerKind kind = RangeAnswerKind::whole;
    // Each at least one byte long and inside the file, no two overlapping. In the order asked for; ascending
    // if some had to be merged.
    std::vector<ByteRange> parts;
};

// `field`: the value of Range, empty where absent.
ResolvedRanges resolveRanges(std::string_view field, std::uint64_t sizeBytes);

std::string contentRange(ByteRange part, std::uint64_t sizeBytes); // "bytes 0-9/100"
std::string unsatisfiedRange(std::uint64_t sizeBytes);             // "bytes */100"

} // namespace stipple::server
