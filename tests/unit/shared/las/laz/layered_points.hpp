// Point records for tests of layered chunks, and their items.
#pragma once

#include "shared/las/laz/layered_chunk.hpp"

#include <random>

namespace stipple::test {

struct LayeredCase {
    int pointFormat = 6;
    std::size_t extraBytes = 0;
    std::uint16_t version = 3;
};

inline las::laz::Items itemsOf(const LayeredCase& of) {
    using las::laz::ItemType;
    las::laz::Items items = {{ItemType::point14, 30, of.version}};
    if (of.pointFormat == 7)
        items.push_back({ItemType::rgb14, 6, of.version});
    if (of.pointFormat == 8 || of.pointFormat == 10)
        items.push_back({ItemType::rgbNir14, 8, of.version});
    if (of.pointFormat >= 9)
        items.push_back({ItemType::wavePacket14, 29, of.version});
    if (of.extraBytes != 0)
        items.push_back({ItemType::byte14, static_cast<std::uint16_t>(of.extraBytes), of.version});
    return items;
}

inline std::size_t recordLengthOf(const las::laz::Items& items) {
    std::size_t length = 0;
    for (const auto& item : items)
        length += item.sizeBytes;
    return length;
}

// Every bit at random.
Bytes randomRecords(const LayeredCase& of, std::size_t count, unsigned seed);
// As a scanner gives them: pulses of 1..15 returns along lines, 1..`channels` scanner channels in turns, GPS
// times that repeat, jump back and forth between lines and by many multiples of a step, sometimes other
// values.
Bytes scannedRecords(const LayeredCase& of, std::size_t count, unsigned seed, unsigned channels);

// The bytes of a chunk, made in pieces of `piece` points, without what lies behind it.
Bytes encodeLayered(const LayeredCase& of, ByteSpan records, std::size_t piece = 1000);
// Decodes in pieces of `piece` points. The chunk is copied to where its padding ends with the allocation.
Result<Bytes> decodeLayered(const LayeredCase& of, ByteSpan chunk, std::size_t points,
                            const las::laz::Layers& wanted = {}, std::size_t piece = 1000);

} // namespace stipple::test
