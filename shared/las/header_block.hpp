// The public header block byte by byte (LAS 1.4 R15 table 3): literal fields, nothing interpreted.
//
//   0 "LASF"            24 version          94 header size       107 count (legacy)    227 waveform u64  1.3
//   4 source id u16     26 system id [32]   96 point offset u32  111 by return 5×u32   235 EVLRs u64     1.4
//   6 encoding u16      58 software [32]   100 VLR count u32     131 scale 3×f64       243 EVLR count u32
//   8 project id [16]   90 day, year u16   104 format u8         155 offset 3×f64      247 count u64
//                                          105 record length u16 179 max,min x,y,z     255 by return 15×u64
#pragma once

#include "shared/base/result.hpp"
#include "shared/las/las_header.hpp"

namespace stipple::las {

inline constexpr std::size_t minHeaderBlockSize = 227; // LAS 1.0-1.2
inline constexpr std::size_t maxHeaderBlockSize = 375; // LAS 1.4
inline constexpr std::size_t vlrHeaderSize = 54, evlrHeaderSize = 60;

struct HeaderBlock {
    std::uint16_t fileSourceId = 0, globalEncoding = 0;
    std::array<std::uint8_t, 16> projectId{};
    std::uint8_t versionMajor = 1, versionMinor = 4;
    std::string systemIdentifier, generatingSoftware;
    std::uint16_t creationDay = 0, creationYear = 0, headerSize = 0;
    std::uint32_t pointDataOffset = 0, vlrCount = 0;
    std::uint8_t pointFormatByte = 0; // bits 6 and 7: LAZ
    std::uint16_t recordLength = 0;
    std::uint32_t legacyPointCount = 0;
    std::array<std::uint32_t, 5> legacyPointsByReturn{};
    Vec3d scale, offset;
    BoxD bounds;
    std::uint64_t waveformOffset = 0;               // 1.3+
    std::uint64_t evlrOffset = 0;                   // 1.4
    std::uint32_t evlrCount = 0;                    // 1.4
    std::uint64_t pointCount = 0;                   // 1.4
    std::array<std::uint64_t, 15> pointsByReturn{}; // 1.4
    bool hasWaveformOffset() const { return versionMinor >= 3 && headerSize >= 235; }
    bool hasLongCounts() const { return versionMinor >= 4 && headerSize >= maxHeaderBlockSize; }
};

// From the first bytes of a file (maxHeaderBlockSize, or fewer where the file is shorter). Errors: corrupt
// (no LAS file, impossible header size), truncated, unsupported (version).
Result<HeaderBlock> decodeHeaderBlock(ByteSpan bytes);
// headerBlockSize(block.versionMinor) bytes.
Bytes encodeHeaderBlock(const HeaderBlock& block);

// Text of a fixed field as UTF-8: kept if it is valid UTF-8, otherwise taken as Latin-1; control
// characters become spaces.
std::string readableText(std::string text);

} // namespace stipple::las
