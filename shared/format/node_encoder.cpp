#include "shared/base/text.hpp"
#include "shared/codec/colour_codec.hpp"
#include "shared/codec/column_codec.hpp"
#include "shared/codec/exact_colour.hpp"
#include "shared/codec/position_codec.hpp"
#include "shared/codec/progressive_order.hpp"
#include "shared/format/block_frame.hpp"
#include "shared/format/cloud_writer.hpp"
#include "shared/format/picture_attributes.hpp"

#include <algorithm>

namespace stipple {

namespace {

Status checkShape(const CloudMetadata& metadata, NodeKey key, const PointBatch& points,
                  std::span<const std::uint16_t> shown) {
    const auto& attributes = metadata.schema.attributes;
    if (key.level > maxLevel || key.level > metadata.rootCube.bits ||
        metadata.rootCube.nodeBits(key.level) > maxNodeBits)
        return Error{ErrorCode::invalidArgument, "nodes of this level hold no points", {}, {}};
    if (points.size() > UINT32_MAX)
        return Error{ErrorCode::limitExceeded, "a node holds at most 2^32 - 1 points", {}, {}};
    STIPPLE_CHECK(checkPictureAttributes(metadata));
    bool fits = points.columns.size() == attributes.size();
    for (std::size_t a = 0; fits && a < attributes.size(); ++a)
        fits = points.columns[a].size() == points.size() * attributes[a].size();
    if (!fits)
        return Error{ErrorCode::invalidArgument, "the points do not have the cloud's attributes", {}, {}};
    std::size_t channels =
        metadata.innerColour == InnerColour::exact ? 0 : pictureAttributes(metadata).size();
    if (!shown.empty() && shown.size() != channels * points.size())
        return Error{ErrorCode::invalidArgument, "what the picture is to show does not fit it", {}, {}};
    return {};
}

// Coordinates relative to the node's minimum corner.
Result<std::vector<Vec3<std::uint32_t>>> inNode(const CloudMetadata& metadata, NodeKey key,
                                                const PointBatch& points) {
    Vec3i corner = metadata.rootCube.nodeMin(key);
    auto size = std::uint64_t{1} << metadata.rootCube.nodeBits(key.level);
    std::vector<Vec3<std::uint32_t>> local(points.size());
    bool inside = true;
    for (std::size_t i = 0; i < local.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) {
            auto steps = static_cast<std::uint64_t>(points.positions[i][axis]) -
                         static_cast<std::uint64_t>(corner[axis]);
            inside = inside && steps < size;
            local[i][axis] = static_cast<std::uint32_t>(steps);
        }
    if (!inside)
        return Error{ErrorCode::outOfRange, "a point lies outside the node", {}, {}};
    return local;
}

// Points at the same place follow in the order of their attributes' bytes, then of what is shown of them, so
// that the input's order leaves no trace.
void orderEqualPoints(const CloudMetadata& metadata, const PointBatch& points,
                      std::span<const std::uint16_t> shown, SortedPoints& sorted) {
    const std::size_t channels = points.size() > 0 ? shown.size() / points.size() : 0;
    auto before = [&](std::uint32_t a, std::uint32_t b) {
        for (std::size_t c = 0; c < points.columns.size(); ++c) {
            std::size_t size = metadata.schema.attributes[c].size();
            const std::uint8_t* column = points.columns[c].data();
            if (int order = std::memcmp(column + a * size, column + b * size, size); order != 0)
                return order < 0;
        }
        std::span<const std::uint16_t> ofA = shown.subspan(a * channels, channels),
                                       ofB = shown.subspan(b * channels, channels);
        return std::lexicographical_compare(ofA.begin(), ofA.end(), ofB.begin(), ofB.end());
    };
    auto same = [&](std::size_t a, std::size_t b) {
        return sorted.keys[a] == sorted.keys[b] && (sorted.lows.empty() || sorted.lows[a] == sorted.lows[b]);
    };
    for (std::size_t i = 0, end = 0; i < sorted.keys.size(); i = end) {
        for (end = i + 1; end < sorted.keys.size() && same(i, end);)
            ++end;
        if (end - i > 1)
            std::sort(sorted.input.begin() + static_cast<std::ptrdiff_t>(i),
                      sorted.input.begin() + static_cast<std::ptrdiff_t>(end), before);
    }
}

// The attribute's values in Morton order.
Bytes sortedColumn(const SortedPoints& sorted, ByteSpan column, std::size_t size) {
    Bytes values(column.size());
    auto gather = [&](auto width) {
        for (std::size_t i = 0; i < sorted.input.size(); ++i)
            std::memcpy(values.data() + i * width, column.data() + sorted.input[i] * width, width);
    };
    switch (size) { // a constant width lets the compiler turn the copy into one move
    case 1:
        gather(std::integral_constant<std::size_t, 1>{});
        break;
    case 2:
        gather(std::integral_constant<std::size_t, 2>{});
        break;
    case 4:
        gather(std::integral_constant<std::size_t, 4>{});
        break;
    case 8:
        gather(std::integral_constant<std::size_t, 8>{});
        break;
    default:
        gather(size);
    }
    return values;
}

std::vector<std::uint16_t> sortedColour(const std::vector<int>& attributes, const PointBatch& points,
                                        const SortedPoints& sorted) {
    std::vector<std::uint16_t> values(sorted.input.size() * attributes.size());
    for (std::size_t c = 0; c < attributes.size(); ++c)
        for (std::size_t i = 0; i < sorted.input.size(); ++i)
            values[i * attributes.size() + c] = points.value<std::uint16_t>(attributes[c], sorted.input[i]);
    return values;
}

// Whether each value is the one before it; of many attributes of many scans they all are.
bool repeatsOneValue(ByteSpan column, std::size_t size) {
    return column.size() <= size ||
           std::memcmp(column.data(), column.data() + size, column.size() - size) == 0;
}

// Of what is shown instead of colours of width `own`: the same precision; 8 bits of 16 are enough to look at.
ColourWidth shownWidth(ColourWidth own, std::size_t channels) {
    return own == ColourWidth::wide && channels == 3 ? ColourWidth::repeated : own;
}

// In Morton order what the picture shows, if that is not the points' own colour.
std::vector<std::uint16_t> sortedShown(std::span<const std::uint16_t> shown, std::size_t channels,
                                       ColourWidth width, const SortedPoints& sorted) {
    std::vector<std::uint16_t> values(shown.size());
    if (shown.empty())
        return values;
    for (std::size_t i = 0; i < sorted.input.size(); ++i)
        for (std::size_t c = 0; c < channels; ++c)
            values[i * channels + c] = shown[sorted.input[i] * channels + c];
    roundTo(width, values);
    return values;
}

// No bytes if the picture shows them.
Bytes exactColourBlock(std::span<const std::uint16_t> exact, std::span<const std::uint16_t> shown,
                       std::size_t channels, ColourWidth width) {
    if (shown.empty() || std::equal(exact.begin(), exact.end(), shown.begin()))
        return {};
    ByteWriter payload;
    writeExactColour(payload, exact, shown, static_cast<int>(channels), width);
    return framePaddedBlock(payload.bytes());
}

Bytes attributeBlock(const CloudMetadata& metadata, const AttributeBlock& block, const PointBatch& points,
                     const SortedPoints& sorted) {
    ByteWriter payload;
    bool allZero = true;
    for (int a : block.attributes) {
        const Attribute& attribute = metadata.schema.attributes[static_cast<std::size_t>(a)];
        const Bytes& column = points.columns[static_cast<std::size_t>(a)];
        const bool isConstant = repeatsOneValue(column, attribute.size());
        auto first = ByteSpan(column).first(std::min(column.size(), attribute.size()));
        allZero = allZero && isConstant &&
                  std::all_of(first.begin(), first.end(), [](std::uint8_t b) { return b == 0; });
        encodeColumn(payload, isConstant ? column : sortedColumn(sorted, column, attribute.size()),
                     attributeTypeSize(attribute.type), static_cast<std::size_t>(attribute.components));
    }
    return allZero ? Bytes{} : framePaddedBlock(payload.bytes());
}

} // namespace

Result<EncodedNode> encodeNode(const CloudMetadata& metadata, NodeKey key, const PointBatch& points,
                               std::span<const std::uint16_t> shown) {
    auto placed = [&](const Error& error) { return error.at("node " + key.text()); };
    if (Status shape = checkShape(metadata, key, points, shown); !shape)
        return placed(shape.error());
    auto local = inNode(metadata, key, points);
    if (!local)
        return placed(local.error());

    SortedPoints sorted = sortPoints(*local);
    orderEqualPoints(metadata, points, shown, sorted);

    EncodedNode node;
    node.key = key;
    node.pointCount = static_cast<std::uint32_t>(points.size());
    std::vector<int> colourAttributes = pictureAttributes(metadata);
    const std::size_t channels = colourAttributes.size();
    std::vector<std::uint16_t> exact = sortedColour(colourAttributes, points, sorted);
    const ColourWidth exactWidth = narrowestWidth(exact);
    const ColourWidth width = shown.empty() ? exactWidth : shownWidth(exactWidth, channels);
    std::vector<std::uint16_t> rounded = sortedShown(shown, channels, width, sorted);
    const std::vector<std::uint16_t>& colour = shown.empty() ? exact : rounded;
    std::size_t sizeBytes = 0;
    for (int stratum = 0; stratum < strataCount; ++stratum) {
        std::size_t count = stratumPoints(node.pointCount, stratum);
        if (count == 0)
            continue;
        ByteWriter payload;
        encodePositions(payload, sorted, stratum);
        if (channels > 0)
            encodeColour(payload, colour, static_cast<int>(channels), width, stratum,
                         neighbourChoices(sorted.keys, stratum));
        std::size_t least = (count + maxPointsPerByte - 1) / maxPointsPerByte;
        if (payload.size() + blockFrameBytes < least)
            payload.bytes().resize(least - blockFrameBytes);
        node.strata[static_cast<std::size_t>(stratum)] = framePaddedBlock(payload.bytes());
        sizeBytes = std::max(sizeBytes, payload.size());
    }
    for (const AttributeBlock& block : attributeBlocks(metadata)) {
        node.attributes.push_back(block.isExactColour ? exactColourBlock(exact, rounded, channels, exactWidth)
                                                      : attributeBlock(metadata, block, points, sorted));
        sizeBytes = std::max(sizeBytes, node.attributes.back().size());
    }
    if (sizeBytes > UINT32_MAX - blockFrameBytes - paddedTo)
        return placed(
            Error{ErrorCode::limitExceeded, "a block of the node is over 4 GB", {}, "split the node"});
    return node;
}

} // namespace stipple
