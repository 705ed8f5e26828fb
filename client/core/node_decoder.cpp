#include "client/core/node_decoder.hpp"

#include "shared/base/text.hpp"
#include "shared/format/cloud_file.hpp"

#include <algorithm>

namespace stipple {

namespace {

template <class T>
std::vector<float> toFloats(ByteSpan column, std::size_t count) {
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = static_cast<float>(loadLe<T>(column.data() + i * sizeof(T)));
    return values;
}

// `count` stored values; the column holds at least as many.
std::vector<float> toFloats(AttributeType type, ByteSpan column, std::size_t count) {
    switch (type) {
    case AttributeType::u8:
        return toFloats<std::uint8_t>(column, count);
    case AttributeType::i8:
        return toFloats<std::int8_t>(column, count);
    case AttributeType::u16:
        return toFloats<std::uint16_t>(column, count);
    case AttributeType::i16:
        return toFloats<std::int16_t>(column, count);
    case AttributeType::u32:
        return toFloats<std::uint32_t>(column, count);
    case AttributeType::i32:
        return toFloats<std::int32_t>(column, count);
    case AttributeType::u64:
        return toFloats<std::uint64_t>(column, count);
    case AttributeType::i64:
        return toFloats<std::int64_t>(column, count);
    case AttributeType::f32:
        return toFloats<float>(column, count);
    case AttributeType::f64:
        return toFloats<double>(column, count);
    }
    return {};
}

// For what is found here; the decoders of blocks name the node themselves.
Error errorAt(const DecodeJob& job, ErrorCode code, std::string what) {
    return {code, std::move(what), "node " + job.entry.key.text(), ""};
}

// The first `count` intensities of the node.
Result<std::vector<float>> decodeIntensity(const DecodeJob& job, std::size_t count, const WorkGate* gate) {
    const CloudMetadata& metadata = *job.metadata;
    int block = intensityBlock(metadata);
    if (block < 0)
        return errorAt(job, ErrorCode::invalidArgument, "the cloud has no block of intensities");
    auto index = static_cast<std::size_t>(block);
    STIPPLE_TRY(columns, decodeAttributes(metadata, job.entry, index, job.intensity, gate));
    int wanted = metadata.schema.find(attribute_names::intensity);
    std::vector<int> attributes = attributeBlocks(metadata)[index].attributes;
    auto column = static_cast<std::size_t>(std::find(attributes.begin(), attributes.end(), wanted) -
                                           attributes.begin());
    const Attribute& attribute = metadata.schema.attributes[static_cast<std::size_t>(wanted)];
    if (columns.size() <= column || columns[column].size() < count * attribute.size())
        return errorAt(job, ErrorCode::corrupt, "the block of intensities is too short");
    return toFloats(attribute.type, columns[column], count);
}

Result<ResidentNode> decodePicturePart(const DecodeJob& job, const WorkGate* gate) {
    const CloudMetadata& metadata = *job.metadata;
    int nodeBits = metadata.rootCube.nodeBits(job.entry.key.level);
    if (nodeBits < 0 || nodeBits > maxNodeBits)
        return errorAt(job, ErrorCode::corrupt, cat("a node 2^", nodeBits, " steps wide can hold no points"));
    STIPPLE_TRY(picture, decodePicture(metadata, job.entry, job.strata, job.picture, gate));
    return packNode(job.entry.key, nodeBits, job.entry.pointCount, picture, metadata.pictureColour,
                    metadata.colourIs8Bit);
}

ResidentNode withoutPicture(const DecodeJob& job) {
    ResidentNode node;
    node.id = nextResidentNodeId();
    node.key = job.entry.key;
    node.pointCount = node.totalPoints = job.entry.pointCount;
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
        return errorAt(job, ErrorCode::invalidArgument, "a decoding job without metadata or strata");
    Result<ResidentNode> node = job.strata == 0 ? withoutPicture(job) : decodePicturePart(job, gate);
    if (!node.ok() || !job.wantsIntensity || job.intensity.empty())
        return node;
    STIPPLE_TRY(intensity, decodeIntensity(job, node->pointCount, gate));
    node->intensity = std::move(intensity);
    return node;
}

int intensityBlock(const CloudMetadata& metadata) {
    int wanted = metadata.schema.find(attribute_names::intensity);
    if (wanted < 0)
        return -1;
    std::vector<AttributeBlock> blocks = attributeBlocks(metadata);
    for (std::size_t i = 0; i < blocks.size(); ++i)
        if (!blocks[i].isExactColour && std::find(blocks[i].attributes.begin(), blocks[i].attributes.end(),
                                                  wanted) != blocks[i].attributes.end())
            return static_cast<int>(i);
    return -1;
}

ResidentNode withIntensity(const ResidentNode& node, const std::vector<float>& intensities) {
    ResidentNode merged = node;
    merged.id = nextResidentNodeId();
    std::size_t count = std::min<std::size_t>(node.pointCount, intensities.size());
    merged.intensity.assign(intensities.begin(), intensities.begin() + static_cast<std::ptrdiff_t>(count));
    return merged;
}

std::unique_ptr<NodeDecoder> makeInlineDecoder() {
    return std::make_unique<InlineDecoder>();
}

} // namespace stipple
