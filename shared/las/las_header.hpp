// The public header block and variable length records of a LAS file, versions 1.0-1.4
// (ASPRS LAS 1.4 R15 §2.4, §2.5, §2.7).
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/geometry/box.hpp"
#include "shared/geometry/grid.hpp"
#include "shared/points/attribute.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stipple::las {

// A variable length record, normal (<= 65,535 bytes) or extended.
struct Vlr {
    std::string userId; // at most 16 characters
    std::uint16_t recordId = 0;
    std::string description; // at most 32 characters
    Bytes data;
    bool extended = false; // EVLR: stored after the points, LAS 1.4 only
    // Read records only: where the data lie in the file, and how many bytes there are.
    std::uint64_t offsetBytes = 0, sizeBytes = 0;
    // The data were left in the file: waveform packets, and what exceeds the limit of loaded records.
    bool omitted = false;

    bool is(std::string_view user, std::uint16_t id) const { return userId == user && recordId == id; }
};

struct Header {
    int versionMajor = 1, versionMinor = 4;
    int pointFormat = 6;            // 0..10
    bool compressed = false;        // LAZ: bit 7 of the point format, or a "laszip encoded" record
    std::uint16_t recordLength = 0; // bytes of a point record, extra bytes included
    std::uint16_t fileSourceId = 0;
    std::uint16_t globalEncoding = 0; // bit 0 GPS time type, bit 4 WKT
    std::array<std::uint8_t, 16> projectId{};
    std::string systemIdentifier, generatingSoftware;
    std::uint16_t creationDay = 0, creationYear = 0; // day of the year from 1; 0: unknown
    std::uint16_t headerSize = 0;
    std::uint32_t pointDataOffset = 0; // of the first point, corrected where the file's is bogus
    std::uint64_t pointCount = 0;      // the one that holds: 64-bit in 1.4, legacy before
    std::array<std::uint64_t, 15> pointsByReturn{};
    Grid grid;
    BoxD bounds;                      // as stated, world units; may lie
    std::uint64_t waveformOffset = 0; // 1.3+
    std::vector<Vlr> vlrs;            // EVLRs too, in file order
};

// Bytes of the header block that LAS 1.`versionMinor` (0..4) defines.
std::size_t headerBlockSize(int versionMinor);
// Bytes of a point record of format 0..10 without extra bytes.
std::size_t pointRecordSize(int pointFormat);
// The highest point format that LAS 1.`versionMinor` defines.
int highestPointFormat(int versionMinor);

// Compares the header's bounds with the points' own box (grid integers). Nothing if they agree to within
// one grid step (stated bounds are decimals that went through a program or two); else one sentence.
std::optional<std::string> boundsContradiction(const Header& header, const BoxI& found);

// The text of the OGC WKT record (LASF_Projection 2112) without its closing NULs; empty if there is none.
std::string wktRecord(const Header& header);

namespace records {
inline constexpr std::string_view projection = "LASF_Projection";
inline constexpr std::uint16_t geoKeyDirectory = 34735, geoDoubleParams = 34736, geoAsciiParams = 34737;
inline constexpr std::uint16_t wktTransform = 2111, wkt = 2112;
inline constexpr std::string_view spec = "LASF_Spec";
inline constexpr std::uint16_t extraBytes = 4, waveformPackets = 65535;
inline constexpr std::string_view laszip = "laszip encoded";
inline constexpr std::uint16_t laszipRecord = 22204;
} // namespace records

} // namespace stipple::las
