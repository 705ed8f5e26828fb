// Attribute values of a node as its file stores them, so nothing is lost to rounding: GPS times keep their
// microseconds, and a class is one byte. One block of the file makes one NodeColumns.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/format/cloud_metadata.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace stipple {

// Instead of an attribute: what a node's picture shows, or would if it showed the points' own colours.
inline constexpr std::int32_t pictureIntensity = -1; // u16; of clouds whose picture is intensity
inline constexpr std::int32_t exactColourWords = -2; // u32, as ResidentNode::colourWords
inline constexpr std::int32_t exactIntensity = -3;   // u16
inline constexpr std::int32_t pictureColours = -4;   // three u16: what colour words can't give back
inline constexpr std::int32_t exactPosition = -5;    // three i64: the point's integers in the cloud's grid

struct NodeColumn {
    std::int32_t attribute = 0;      // index into the schema, or one of the above
    std::uint32_t bytesPerPoint = 0; // of all components
    friend bool operator==(const NodeColumn&, const NodeColumn&) = default;
};

struct NodeColumns {
    std::uint32_t pointCount = 0; // a prefix of the progressive order
    std::vector<NodeColumn> columns;
    Bytes values; // one column after the other, each pointCount × bytesPerPoint, little-endian

    // Empty if there is no such column.
    ByteSpan column(std::int32_t attribute) const;
    // Beside the object itself.
    std::uint64_t sizeBytes() const { return columns.size() * sizeof(NodeColumn) + values.size(); }
    friend bool operator==(const NodeColumns&, const NodeColumns&) = default;
};

// Index of an attribute by name, upper or lower case; -1 if the schema has none.
int findAttribute(const Schema& schema, std::string_view name);

// All that the attribute can mean are whole numbers.
bool isWhole(const Attribute& attribute);

// What the first `count` values of a column mean: offset + scale × stored, of several components the first;
// NaN for "no value". The column holds that many. Integers beyond 2^53 are rounded.
std::vector<double> meaningsOf(const Attribute& attribute, ByteSpan column, std::size_t count);

} // namespace stipple
