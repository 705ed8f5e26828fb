// One thing that is wanted of a cloud's file, and what came of asking for it.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"
#include "shared/io/byte_source.hpp"

#include <compare>
#include <cstdint>

namespace stipple {

enum class LoadKind : std::uint8_t { opening, chunk, picture, attributes, points, region };

struct LoadKey {
    std::uint32_t cloud = 0;
    LoadKind kind = LoadKind::opening;
    std::uint64_t id = 0;   // of a node; opening: the offset; region: RegionScan::keyId()
    std::int32_t block = 0; // attributes: of the node's further blocks; region: the scan
    friend auto operator<=>(const LoadKey&, const LoadKey&) = default;
};

struct LoadItem {
    LoadKey key;
    ByteRange range;
    int fromStrata = 0, strata = 0; // picture: the strata before these bytes and with them
    Bytes head;                     // first bytes that are here already; `range` is what is missing
    bool mayEndEarly = false;       // the file may end inside the range
};

struct Loaded {
    LoadItem item;
    Result<Bytes> bytes; // head and range together
};

// Bytes that nobody asked for, between ranges that travelled together.
struct LoadedGap {
    std::uint32_t cloud = 0;
    std::uint64_t offset = 0;
    Bytes bytes;
};

} // namespace stipple
