// A chunk of compressed points and who turns it into point records and back. The items (which parts of a
// record are compressed how) are those of the LASzip record; a codec is made for one list of them and used
// for chunk after chunk.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace stipple::las::laz {

// What LASzip calls items, by its numbers.
enum class ItemType : std::uint16_t {
    byte = 0, // the extra bytes of formats 0-5
    point10 = 6,
    gpsTime11 = 7,
    rgb12 = 8,
    wavePacket13 = 9,
    point14 = 10,
    rgb14 = 11,
    rgbNir14 = 12,
    wavePacket14 = 13,
    byte14 = 14,
};

// Items follow one another in a point record without gaps.
struct Item {
    ItemType type = ItemType::point10;
    std::uint16_t sizeBytes = 0;
    std::uint16_t version = 0; // 0: not compressed; 1, 2: pointwise; 3, 4: layered

    friend bool operator==(const Item&, const Item&) = default;
};
using Items = std::vector<Item>;

// Which layers of a layered chunk to decode. X, Y, return numbers and scanner channel always are; the bits
// are those of LASzip.
struct Layers {
    enum : std::uint32_t {
        z = 1u << 0,
        classification = 1u << 1,
        flags = 1u << 2, // synthetic … overlap, scan direction, edge of flight line
        intensity = 1u << 3,
        scanAngle = 1u << 4,
        userData = 1u << 5,
        pointSource = 1u << 6,
        gpsTime = 1u << 7,
        rgb = 1u << 8,
        nir = 1u << 9,
        wavePacket = 1u << 10,
        all = 0xFFFFFFFFu,
    };
    std::uint32_t fields = all;
    std::vector<bool> extraBytes; // one for each extra byte of a record; empty: all of them

    bool has(std::uint32_t layer) const { return (fields & layer) != 0; }
    bool hasExtraByte(std::size_t index) const { return extraBytes.empty() || extraBytes[index]; }
};

// So many readable bytes lie behind a chunk that is decoded, of any value: decoders look for the end once a
// record (or less often, as they state), not at each byte.
constexpr std::size_t decodePadding(std::size_t recordLength) {
    return 4096 + 8 * recordLength;
}

class ChunkDecoder {
  public:
    virtual ~ChunkDecoder() = default;

    // Begins a chunk of `points` > 0 points. `chunk` is all of it, from its first raw record on; it and the
    // padding behind it stay until the next start(). Errors: truncated, corrupt.
    virtual Status start(ByteSpan chunk, std::uint64_t points) = 0;

    // The next records.size() / record length points of the chunk (never asked for more than there are).
    // Fields of layers that are not wanted are zero, all other bytes those of the point. Errors: truncated,
    // corrupt; then the chunk can't go on. `where` of errors is left empty for the caller, who knows the
    // file.
    virtual Status decode(std::span<std::uint8_t> records) = 0;
};

class ChunkEncoder {
  public:
    virtual ~ChunkEncoder() = default;

    virtual void start() = 0;
    // Adds whole records to the chunk. At least one between start() and finish(), at most 2^32 - 1.
    virtual void encode(ByteSpan records) = 0;
    // The bytes of the chunk, valid until the next start().
    virtual ByteSpan finish() = 0;
};

} // namespace stipple::las::laz
