#include "converter/build/describe.hpp"

#include "shared/base/text.hpp"
#include "shared/codec/position_codec.hpp"
#include "shared/format/block_frame.hpp"
#include "shared/format/cloud_file.hpp"

#include <algorithm>

namespace stipple {

namespace {
void addToLevel(std::vector<LevelSummary>& levels, const NodeEntry& entry) {
    levels.resize(std::max<std::size_t>(levels.size(), std::size_t{entry.key.level} + 1));
    LevelSummary& level = levels[entry.key.level];
    ++level.nodes;
    level.points += entry.pointCount;
    level.bytes += entry.sizeBytes();
    if (entry.pointCount == 0)
        return;
    level.smallestNode =
        level.smallestNode == 0 ? entry.pointCount : std::min(level.smallestNode, entry.pointCount);
    level.largestNode = std::max(level.largestNode, entry.pointCount);
}

// Bytes of the positions in a node's picture; the rest is colour. Frames count as positions.
Result<std::uint64_t> positionBytes(const CloudMetadata& metadata, const NodeEntry& entry, ByteSpan picture) {
    PositionDecoder positions(entry.pointCount, metadata.rootCube.nodeBits(entry.key.level), strataCount);
    std::uint64_t sum = 0;
    std::size_t at = 0;
    for (int s = 0; s < strataCount; ++s) {
        std::size_t size = entry.strataBytes[static_cast<std::size_t>(s)];
        if (size == 0)
            continue;
        STIPPLE_TRY(payload,
                    unframeBlock(picture.subspan(at, size), cat("stratum ", s), entry.offsetBytes + at));
        ByteReader reader(payload);
        STIPPLE_CHECK(positions.decode(s, reader));
        sum += blockFrameBytes + reader.position();
        at += size;
    }
    return sum;
}

std::vector<PartSummary> nameParts(const CloudMetadata& metadata) {
    std::vector<PartSummary> parts{{"picture", 0}};
    for (const AttributeBlock& block : attributeBlocks(metadata)) {
        std::string name;
        for (int a : block.attributes)
            name += (name.empty() ? "" : ", ") + metadata.schema.attributes[static_cast<std::size_t>(a)].name;
        parts.push_back({block.isExactColour ? "exact colour of inner nodes" : name, 0});
    }
    return parts;
}
} // namespace

Result<CloudSummary> describeCloud(ByteSource& source, bool splitPicture) {
    STIPPLE_TRY(reader, CloudReader::open(source));
    CloudSummary summary;
    summary.metadata = reader->metadata();
    summary.fileBytes = reader->header().fileBytes;
    summary.metadataBytes = reader->header().metadata.size;
    summary.parts = nameParts(summary.metadata);
    std::uint64_t positions = 0;
    STIPPLE_CHECK(reader->visitNodes([&](const NodeEntry& entry) -> Status {
        addToLevel(summary.levels, entry);
        ++summary.nodes;
        summary.nodeBytes += entry.sizeBytes();
        summary.parts[0].bytes += entry.strataRange(strataCount).size;
        for (std::size_t b = 0; b < entry.attributeBytes.size(); ++b)
            summary.parts[b + 1].bytes += entry.attributeBytes[b];
        if (splitPicture && entry.pointCount > 0) {
            STIPPLE_TRY(picture, readNow(source, entry.strataRange(strataCount)));
            STIPPLE_TRY(bytes, positionBytes(summary.metadata, entry, picture));
            positions += bytes;
        }
        return {};
    }));
    summary.hierarchyBytes = summary.fileBytes - fileHeaderBytes - summary.metadataBytes - summary.nodeBytes;
    if (splitPicture) {
        std::uint64_t colour = summary.parts[0].bytes - positions;
        summary.parts[0] = {"positions", positions};
        summary.parts.insert(summary.parts.begin() + 1, {"colour", colour});
    }
    return summary;
}

} // namespace stipple
