#include "client/core/node_decoder.hpp"

#include "shared/base/text.hpp"
#include "shared/format/cloud_file.hpp"

#include <numeric>

namespace stipple {

namespace {

// For what is found here; the decoders of blocks name the node themselves.
Error errorAt(const DecodeJob& job, ErrorCode code, Phrase what) {
    return {code, std::move(what), "node " + job.entry.key.text(), ""};
}

// The picture without places whose colours the exact ones are coded against.
Result<NodePicture> shownPicture(const DecodeJob& job) {
    std::size_t channels = job.metadata->pictureColour == PictureColour::rgb ? 3 : 1;
    if (job.shown.size() != job.entry.pointCount * channels * 2)
        return errorAt(job, ErrorCode::invalidArgument,
                       say("exact colours without the colours that are shown"));
    NodePicture picture;
    picture.positions.resize(job.entry.pointCount);
    for (std::size_t at = 0; at < job.shown.size(); at += 2)
        picture.colour.push_back(loadLe<std::uint16_t>(job.shown.data() + at));
    return picture;
}

Result<NodeColumns> decodeExact(const DecodeJob& job) {
    const CloudMetadata& metadata = *job.metadata;
    STIPPLE_TRY(picture, shownPicture(job));
    STIPPLE_CHECK(decodeExactColour(metadata, job.entry, job.attributes, picture));
    ByteWriter values;
    if (metadata.pictureColour == PictureColour::rgb)
        for (std::size_t i = 0; i < picture.colour.size(); i += 3)
            values.write(colourWord(picture.colour[i], picture.colour[i + 1], picture.colour[i + 2],
                                    metadata.colourIs8Bit));
    else
        for (std::uint16_t value : picture.colour)
            values.write(value);
    NodeColumn column = metadata.pictureColour == PictureColour::rgb ? NodeColumn{exactColourWords, 4}
                                                                     : NodeColumn{exactIntensity, 2};
    return NodeColumns{job.entry.pointCount, {column}, values.take()};
}

Result<NodeColumns> decodeColumns(const DecodeJob& job, const WorkGate* gate) {
    const CloudMetadata& metadata = *job.metadata;
    std::vector<AttributeBlock> blocks = attributeBlocks(metadata);
    auto index = static_cast<std::size_t>(job.block);
    if (job.block < 0 || index >= blocks.size() || job.entry.attributeBytes.size() != blocks.size())
        return errorAt(job, ErrorCode::invalidArgument, say("the node has no block ", job.block));
    if (blocks[index].isExactColour)
        return decodeExact(job);
    STIPPLE_TRY(columns, decodeAttributes(metadata, job.entry, index, job.attributes, gate));
    NodeColumns made;
    made.pointCount = job.entry.pointCount;
    for (std::size_t c = 0; c < blocks[index].attributes.size(); ++c) {
        int attribute = blocks[index].attributes[c];
        std::size_t size = metadata.schema.attributes[static_cast<std::size_t>(attribute)].size();
        if (c >= columns.size() || columns[c].size() != size * job.entry.pointCount)
            return errorAt(job, ErrorCode::corrupt, say("a block of attributes is too short"));
        made.columns.push_back({attribute, static_cast<std::uint32_t>(size)});
        made.values.insert(made.values.end(), columns[c].begin(), columns[c].end());
    }
    return made;
}

Result<ResidentNode> decodePicturePart(const DecodeJob& job, const WorkGate* gate) {
    const CloudMetadata& metadata = *job.metadata;
    int nodeBits = metadata.rootCube.nodeBits(job.entry.key.level);
    if (nodeBits < 0 || nodeBits > maxNodeBits)
        return errorAt(job, ErrorCode::corrupt, say("a node 2^", nodeBits, " steps wide can hold no points"));
    STIPPLE_TRY(picture, decodePicture(metadata, job.entry, job.strata, job.picture, gate));
    ResidentNode node = packNode(job.entry.key, nodeBits, job.entry.pointCount, picture,
                                 metadata.pictureColour, metadata.colourIs8Bit);
    if (metadata.innerColour == InnerColour::mean && job.entry.childMask != 0)
        keepShownColours(node, picture);
    return node;
}

Result<PointBatch> decodeWhole(const DecodeJob& job, const WorkGate* gate) {
    NodeBytes whole;
    whole.entry = job.entry;
    whole.attributes.resize(job.metadata->schema.attributes.size());
    std::iota(whole.attributes.begin(), whole.attributes.end(), 0);
    whole.bytes = job.picture;
    return decodeNode(*job.metadata, whole, gate);
}

Result<NodeColumns> decodePoints(const DecodeJob& job, const WorkGate* gate) {
    STIPPLE_TRY(batch, decodeWhole(job, gate));
    for (std::uint32_t point : job.points)
        if (point >= batch.size())
            return errorAt(job, ErrorCode::invalidArgument, say("the node has no point ", point));
    NodeColumns made;
    made.pointCount = static_cast<std::uint32_t>(job.points.size());
    ByteWriter values;
    made.columns.push_back({exactPosition, 3 * sizeof(std::int64_t)});
    for (std::uint32_t point : job.points)
        for (std::int64_t step :
             {batch.positions[point].x, batch.positions[point].y, batch.positions[point].z})
            values.write(step);
    for (std::size_t a = 0; a < batch.columns.size(); ++a) {
        std::size_t size = job.metadata->schema.attributes[a].size();
        made.columns.push_back({static_cast<std::int32_t>(a), static_cast<std::uint32_t>(size)});
        for (std::uint32_t point : job.points)
            values.writeBytes({batch.columns[a].data() + point * size, size});
    }
    made.values = values.take();
    return made;
}

ResidentNode columnNode(const DecodeJob& job, NodeColumns columns) {
    ResidentNode node;
    node.id = nextResidentNodeId();
    node.key = job.entry.key;
    node.pointCount = columns.pointCount;
    node.totalPoints = job.entry.pointCount;
    node.columns = std::move(columns);
    return node;
}

class InlineDecoder final : public NodeDecoder {
  public:
    void decode(DecodeJob job, Completion done) override { done(decodeNode(job)); }
    int pump(std::chrono::milliseconds) override { return 0; }
    std::size_t pending() const override { return 0; }
};

} // namespace

Result<ResidentNode> decodeNode(const DecodeJob& job, const WorkGate* gate) {
    if (!job.metadata || job.strata < 0 || job.strata > strataCount)
        return errorAt(job, ErrorCode::invalidArgument, say("a decoding job without metadata or strata"));
    if (job.strata > 0 && job.points.empty())
        return decodePicturePart(job, gate);
    STIPPLE_TRY(columns, job.points.empty() ? decodeColumns(job, gate) : decodePoints(job, gate));
    return columnNode(job, std::move(columns));
}

std::unique_ptr<NodeDecoder> makeInlineDecoder() {
    return std::make_unique<InlineDecoder>();
}

} // namespace stipple
