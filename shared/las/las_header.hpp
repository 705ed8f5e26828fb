// The public header block and variable length records of a LAS file, versions 1.0-1.4
// (ASPRS LAS 1.4 R15 §2.4, §2.5, §2.7).
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/geometry/box.hpp"
#include "shared/geometry/grid.hpp"
#include "shared/points/attribute.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace stipple::las {

// A variable length record, normal (<= 65,535 bytes) or extended.
struct Vlr {
    std::string userId; // at most 16 characters
    std::uint16_t recordId = 0;
    std::string description; // at most 32 characters
    Bytes data;
    bool extended = false; // EVLR: stored after the points, LAS 1.4 only
};

struct Header {
    int versionMajor = 1, versionMinor = 4;
    int pointFormat = 6;            // 0..10
    bool compressed = false;        // LAZ: bit 7 of the point format, and a "laszip encoded" record
    std::uint16_t recordLength = 0; // bytes of a point record, extra bytes included
    std::uint16_t fileSourceId = 0;
    std::uint16_t globalEncoding = 0; // bit 0 GPS time type, bit 4 WKT
    std::array<std::uint8_t, 16> projectId{};
    std::string systemIdentifier, generatingSoftware;
    std::uint16_t creationDay = 0, creationYear = 0;
    std::uint32_t pointDataOffset = 0;
    std::uint64_t pointCount = 0; // the one that holds: 64-bit in 1.4, legacy before
    std::array<std::uint64_t, 15> pointsByReturn{};
    Grid grid;
    BoxD bounds;                      // as stated, world units; may lie
    std::uint64_t waveformOffset = 0; // 1.3+
    std::vector<Vlr> vlrs;            // EVLRs too, in file order
};

} // namespace stipple::las
