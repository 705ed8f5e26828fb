#include "shared/base/text.hpp"
#include "shared/codec/section.hpp"
#include "shared/codec/varint.hpp"
#include "shared/format/block_frame.hpp"
#include "shared/format/file_parts.hpp"

#include <algorithm>

namespace stipple {

namespace {

constexpr std::uint8_t noParent = 0xFF;

Error corrupt(std::string what) {
    return Error{ErrorCode::corrupt, std::move(what), "hierarchy chunk", {}};
}

// One column of varints, as it is read.
class Column {
  public:
    explicit Column(Bytes bytes) : bytes_(std::move(bytes)), reader_(bytes_) {}
    std::uint64_t next() { return readVarint(reader_); }
    bool finished() const { return reader_.ok() && reader_.remaining() == 0; }

  private:
    Bytes bytes_;
    ByteReader reader_;
};

// A column of varints has at most ten bytes a node.
Result<Column> readColumn(ByteReader& from, std::uint32_t nodes) {
    Bytes room(10 * std::size_t{nodes});
    STIPPLE_TRY(size, readSection(from, room));
    room.resize(size);
    return Column(std::move(room));
}

bool validKey(const NodeKey& key) {
    std::uint64_t side = std::uint64_t{1} << std::min<int>(key.level, 32);
    return key.level <= maxLevel && key.x < side && key.y < side && key.z < side;
}

} // namespace

// [u8 parent level | 255] [u8 parent's child mask] [u16 0] [u32 x y z of the parent] [u32 nodes]
// [u64 data offset] [u64 offset of child chunks] [section per column of varints]:
// child mask | points | stratum 0…3 bytes | attribute block bytes… | child chunk bytes (only of nodes with
// children: 0 = in this chunk)
Bytes writeHierarchyChunk(const HierarchyChunk& chunk, std::size_t attributeBlockCount) {
    ByteWriter to;
    to.write(chunk.isRoot ? noParent : chunk.parent.level);
    to.write(chunk.parentChildMask);
    to.write<std::uint16_t>(0);
    to.write(chunk.parent.x);
    to.write(chunk.parent.y);
    to.write(chunk.parent.z);
    to.write(static_cast<std::uint32_t>(chunk.nodes.size()));
    to.write(chunk.dataOffset);
    to.write(chunk.childChunksOffset);
    auto column = [&](auto value) {
        ByteWriter bytes;
        for (const NodeEntry& node : chunk.nodes)
            value(bytes, node);
        writeSection(to, bytes.bytes(), Effort::thorough);
    };
    column([](ByteWriter& bytes, const NodeEntry& node) { writeVarint(bytes, node.childMask); });
    column([](ByteWriter& bytes, const NodeEntry& node) { writeVarint(bytes, node.pointCount); });
    for (std::size_t s = 0; s < strataCount; ++s)
        column([s](ByteWriter& bytes, const NodeEntry& node) { writeVarint(bytes, node.strataBytes[s]); });
    for (std::size_t b = 0; b < attributeBlockCount; ++b)
        column([b](ByteWriter& bytes, const NodeEntry& node) {
            writeVarint(bytes, node.attributeBytes.empty() ? 0 : node.attributeBytes[b]);
        });
    column([](ByteWriter& bytes, const NodeEntry& node) {
        if (node.childMask != 0)
            writeVarint(bytes, node.childChunk.size);
    });
    return frameBlock(to.bytes());
}

Result<std::vector<NodeEntry>> parseHierarchyChunk(const CloudMetadata& metadata, std::uint64_t fileBytes,
                                                   ByteSpan block) {
    STIPPLE_TRY(payload, unframeBlock(block, "hierarchy chunk", 0));
    ByteReader from(payload);
    NodeKey parent;
    parent.level = from.read<std::uint8_t>();
    auto parentMask = from.read<std::uint8_t>();
    auto zero = from.read<std::uint16_t>();
    parent.x = from.read<std::uint32_t>();
    parent.y = from.read<std::uint32_t>();
    parent.z = from.read<std::uint32_t>();
    auto nodeCount = from.read<std::uint32_t>();
    auto dataOffset = from.read<std::uint64_t>();
    auto childChunksOffset = from.read<std::uint64_t>();
    if (!from.ok())
        return Error{ErrorCode::truncated, "the chunk's head ends early", "hierarchy chunk", {}};
    if (nodeCount > maxChunkNodes)
        return Error{
            ErrorCode::limitExceeded, cat("a chunk of ", nodeCount, " nodes"), "hierarchy chunk", {}};
    if (zero != 0 || dataOffset > fileBytes || childChunksOffset > fileBytes)
        return corrupt("the chunk's head does not fit the file");

    std::vector<NodeEntry> nodes;
    nodes.reserve(nodeCount);
    auto append = [&](const NodeKey& key) {
        if (!validKey(key) || nodes.size() == nodeCount)
            return false;
        nodes.emplace_back().key = key;
        return true;
    };
    auto appendChildren = [&](const NodeKey& of, std::uint8_t mask) {
        for (int c = 0; c < 8; ++c)
            if ((mask >> c) & 1 && !append(of.child(c)))
                return false;
        return true;
    };
    bool isRoot = parent.level == noParent;
    if (isRoot ? !append(NodeKey{}) : !validKey(parent) || !appendChildren(parent, parentMask))
        return corrupt("the chunk's nodes do not fit the octree");

    std::size_t attributeBlockCount = attributeBlocks(metadata).size();
    std::vector<Column> columns;
    for (std::size_t c = 0; c < 2 + strataCount + attributeBlockCount + 1; ++c) {
        STIPPLE_TRY(column, readColumn(from, nodeCount));
        columns.push_back(std::move(column));
    }
    if (from.remaining() > 0)
        return corrupt("bytes are left over");

    bool fits = true;
    auto size32 = [&](std::uint64_t value) {
        fits = fits && value <= UINT32_MAX;
        return static_cast<std::uint32_t>(value);
    };
    for (std::size_t i = 0; i < nodes.size() && fits; ++i) {
        // Only this node's fields first: appending children moves the entries.
        NodeEntry node = std::move(nodes[i]);
        std::uint64_t mask = columns[0].next();
        node.childMask = static_cast<std::uint8_t>(mask);
        node.pointCount = size32(columns[1].next());
        for (std::size_t s = 0; s < strataCount; ++s)
            node.strataBytes[s] = size32(columns[2 + s].next());
        node.attributeBytes.resize(attributeBlockCount);
        for (std::size_t b = 0; b < attributeBlockCount; ++b)
            node.attributeBytes[b] = size32(columns[2 + strataCount + b].next());
        node.offsetBytes = dataOffset;
        fits = fits && mask < 256 && node.sizeBytes() <= fileBytes - dataOffset;
        dataOffset += node.sizeBytes();
        if (node.childMask != 0) {
            std::uint64_t chunkBytes = columns.back().next();
            if (chunkBytes > 0) {
                fits = fits && chunkBytes <= maxChunkBytes && chunkBytes <= fileBytes - childChunksOffset;
                node.childChunk = {childChunksOffset, chunkBytes};
                childChunksOffset += chunkBytes;
            }
        }
        bool childrenHere = node.childMask != 0 && node.childChunk.size == 0;
        NodeKey key = node.key;
        std::uint8_t childMask = node.childMask;
        nodes[i] = std::move(node);
        fits = fits && (!childrenHere || appendChildren(key, childMask));
    }
    if (!fits || nodes.size() != nodeCount ||
        !std::all_of(columns.begin(), columns.end(), [](const Column& c) { return c.finished(); }))
        return corrupt("the chunk's nodes contradict each other or the size of the file");
    return nodes;
}

} // namespace stipple
