#include "shared/base/text.hpp"
#include "shared/codec/colour_codec.hpp"
#include "shared/codec/column_codec.hpp"
#include "shared/codec/exact_colour.hpp"
#include "shared/codec/position_codec.hpp"
#include "shared/codec/progressive_order.hpp"
#include "shared/format/block_frame.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/format/picture_attributes.hpp"

#include <algorithm>

namespace stipple {

namespace {

// 32-bit builds cannot address what a very large node takes.
Status checkMemory(std::uint64_t pointCount, std::uint64_t bytesPerPoint) {
    if (pointCount > SIZE_MAX / 2 / bytesPerPoint)
        return Error{
            ErrorCode::limitExceeded, say("the node is too large for the memory of this program"), {}, {}};
    return {};
}

// What keeps a claimed number of points within what the bytes justify.
Status checkEntry(const CloudMetadata& metadata, const NodeEntry& entry) {
    for (int s = 0; s < strataCount; ++s) {
        std::uint64_t bytes = entry.strataBytes[static_cast<std::size_t>(s)];
        if (stratumPoints(entry.pointCount, s) > maxPointsPerByte * bytes)
            return Error{ErrorCode::corrupt,
                         say("stratum ", s, " has ", stratumPoints(entry.pointCount, s), " points in ", bytes,
                             " bytes"),
                         {},
                         {}};
    }
    if (entry.key.level > metadata.rootCube.bits ||
        (entry.pointCount > 0 && metadata.rootCube.nodeBits(entry.key.level) > maxNodeBits))
        return Error{ErrorCode::corrupt, say("a node of this level cannot hold points"), {}, {}};
    return checkMemory(entry.pointCount, 64); // keys, positions and colour while they are being decoded
}

Status checkSize(ByteSpan bytes, std::uint64_t expected) {
    if (bytes.size() != expected)
        return Error{bytes.size() < expected ? ErrorCode::truncated : ErrorCode::invalidArgument,
                     say(bytes.size(), " bytes came instead of ", expected),
                     {},
                     {}};
    return {};
}

Error corrupt(Phrase what) {
    return Error{ErrorCode::corrupt, std::move(what), {}, {}};
}

Result<NodePicture> decodeStrata(const CloudMetadata& metadata, const NodeEntry& entry, int strata,
                                 ByteSpan bytes, const WorkGate* gate) {
    STIPPLE_CHECK(checkSize(bytes, entry.strataRange(strata).size));
    STIPPLE_CHECK(checkEntry(metadata, entry));
    STIPPLE_CHECK(checkPictureAttributes(metadata));
    NodePicture picture;
    if (entry.pointCount == 0)
        return picture;
    PositionDecoder positions(entry.pointCount, metadata.rootCube.nodeBits(entry.key.level), strata, gate);
    auto channels = static_cast<int>(pictureAttributes(metadata).size());
    ColourDecoder colour(entry.pointCount, channels, strata, gate);
    std::size_t at = 0;
    for (int s = 0; s < strata; ++s) {
        std::size_t size = entry.strataBytes[static_cast<std::size_t>(s)];
        if (stratumPoints(entry.pointCount, s) == 0) {
            if (size != 0)
                return corrupt(say("stratum ", s, " has bytes but no points"));
            continue;
        }
        std::string name = cat("stratum ", s);
        STIPPLE_TRY(payload, unframeBlock(bytes.subspan(at, size), name, entry.offsetBytes + at));
        auto placed = [&](const Error& error) {
            return error.at(cat(name, ", byte ", entry.offsetBytes + at));
        };
        ByteReader reader(payload);
        if (Status status = positions.decode(s, reader); !status)
            return placed(status.error());
        if (channels > 0)
            if (Status status = colour.decode(s, reader, positions.choices()); !status)
                return placed(status.error());
        ByteSpan padding = reader.readBytes(reader.remaining());
        if (std::any_of(padding.begin(), padding.end(), [](std::uint8_t byte) { return byte != 0; }))
            return placed(corrupt(say("bytes are left over")));
        at += size;
    }
    STIPPLE_TRY(coordinates, positions.takePositions());
    picture.positions = std::move(coordinates);
    picture.colour = colour.takeValues();
    return picture;
}

// From Morton order to progressive order.
Result<Bytes> progressiveColumn(const std::vector<std::uint32_t>& order, const Bytes& sorted,
                                std::size_t size, const WorkGate* gate) {
    Bytes column(sorted.size());
    auto gather = [&](auto width) {
        return inPieces(gate, order.size(), [&](std::size_t first, std::size_t end) {
            for (std::size_t i = first; i < end; ++i)
                std::memcpy(column.data() + i * width, sorted.data() + order[i] * width, width);
        });
    };
    auto gathered = [&]() -> Status {
        switch (size) { // a constant width lets the compiler turn the copy into one move
        case 1:
            return gather(std::integral_constant<std::size_t, 1>{});
        case 2:
            return gather(std::integral_constant<std::size_t, 2>{});
        case 4:
            return gather(std::integral_constant<std::size_t, 4>{});
        case 8:
            return gather(std::integral_constant<std::size_t, 8>{});
        default:
            return gather(size);
        }
    };
    STIPPLE_CHECK(gathered());
    return column;
}

Result<std::vector<Bytes>> decodeBlock(const CloudMetadata& metadata, const NodeEntry& entry,
                                       std::size_t block, ByteSpan bytes, const WorkGate* gate) {
    std::vector<AttributeBlock> blocks = attributeBlocks(metadata);
    if (block >= blocks.size() || entry.attributeBytes.size() != blocks.size())
        return Error{ErrorCode::invalidArgument, say("the cloud has no such block"), {}, {}};
    if (blocks[block].isExactColour)
        return Error{ErrorCode::invalidArgument, say("exact colours are no attributes of their own"), {}, {}};
    STIPPLE_CHECK(checkSize(bytes, entry.attributeRange(block).size));
    STIPPLE_CHECK(checkEntry(metadata, entry));
    std::vector<Bytes> columns;
    const auto& attributes = metadata.schema.attributes;
    for (int a : blocks[block].attributes)
        STIPPLE_CHECK(checkMemory(entry.pointCount, attributes[static_cast<std::size_t>(a)].size()));
    if (bytes.empty()) {
        for (int a : blocks[block].attributes)
            columns.emplace_back(entry.pointCount * attributes[static_cast<std::size_t>(a)].size());
        return columns;
    }
    STIPPLE_TRY(payload, unframeBlock(bytes, "attribute block", entry.attributeRange(block).offset));
    ByteReader reader(payload);
    STIPPLE_TRY(order, progressiveOrder(entry.pointCount, gate));
    for (int a : blocks[block].attributes) {
        const Attribute& attribute = attributes[static_cast<std::size_t>(a)];
        auto sorted = decodeColumn(reader, entry.pointCount, attributeTypeSize(attribute.type),
                                   static_cast<std::size_t>(attribute.components), gate);
        if (!sorted)
            return sorted.error().at(cat("attribute \"", attribute.name, "\", block at byte ",
                                         entry.attributeRange(block).offset));
        STIPPLE_TRY(column, progressiveColumn(order, *sorted, attribute.size(), gate));
        columns.push_back(std::move(column));
    }
    if (reader.remaining() > 0)
        return corrupt(
            say("bytes are left over in the attribute block at byte ", entry.attributeRange(block).offset));
    return columns;
}

Status decodeExactBlock(const CloudMetadata& metadata, const NodeEntry& entry, ByteSpan bytes,
                        NodePicture& picture, const WorkGate* gate) {
    std::vector<AttributeBlock> blocks = attributeBlocks(metadata);
    std::size_t channels = pictureAttributes(metadata).size();
    if (blocks.empty() || !blocks[0].isExactColour || entry.attributeBytes.size() != blocks.size() ||
        picture.size() > entry.pointCount || picture.colour.size() != channels * picture.size())
        return Error{
            ErrorCode::invalidArgument, say("there is no block of exact colours to this picture"), {}, {}};
    ByteRange range = entry.attributeRange(0);
    STIPPLE_CHECK(checkSize(bytes, range.size));
    if (bytes.empty())
        return {};
    STIPPLE_TRY(payload, unframeBlock(bytes, "exact colours", range.offset));
    ByteReader reader(payload);
    STIPPLE_TRY(order, progressiveOrder(entry.pointCount, gate));
    Status decoded = readExactColour(reader, order, static_cast<int>(channels), picture.colour, gate);
    if (decoded && reader.remaining() > 0)
        decoded = corrupt(say("bytes are left over"));
    return decoded ? decoded : Status(decoded.error().at(cat("exact colours, byte ", range.offset)));
}

} // namespace

Result<NodePicture> decodePicture(const CloudMetadata& metadata, const NodeEntry& entry, int strata,
                                  ByteSpan bytes, const WorkGate* gate) {
    if (strata < 1 || strata > strataCount)
        return Error{ErrorCode::invalidArgument, say("a node has no ", strata, " strata"), {}, {}};
    auto picture = decodeStrata(metadata, entry, strata, bytes, gate);
    if (!picture)
        return picture.error().at("node " + entry.key.text());
    return picture;
}

Result<std::vector<Bytes>> decodeAttributes(const CloudMetadata& metadata, const NodeEntry& entry,
                                            std::size_t block, ByteSpan bytes, const WorkGate* gate) {
    auto columns = decodeBlock(metadata, entry, block, bytes, gate);
    if (!columns)
        return columns.error().at("node " + entry.key.text());
    return columns;
}

Status decodeExactColour(const CloudMetadata& metadata, const NodeEntry& entry, ByteSpan bytes,
                         NodePicture& picture, const WorkGate* gate) {
    Status decoded = decodeExactBlock(metadata, entry, bytes, picture, gate);
    return decoded ? decoded : Status(decoded.error().at("node " + entry.key.text()));
}

} // namespace stipple
