#include "shared/base/text.hpp"
#include "shared/codec/section.hpp"
#include "shared/codec/varint.hpp"
#include "shared/format/block_frame.hpp"
#include "shared/format/file_parts.hpp"

#include <algorithm>

namespace stipple {

namespace {

constexpr std::uint8_t noParent = 0xFF;

Error corrupt(Phrase what) {
    return Error{ErrorCode::corrupt, std::move(what), "hierarchy chunk", {}};
}

// A size as the difference to what the nodes before suggest: a block's bytes grow with the points it holds,
// and those of a stratum with those of the stratum before. The last few nodes count most.
class SizeModel {
  public:
    // `reference` is what the size is in proportion to; < 2^32, as the result.
    std::int64_t predict(std::uint64_t reference) const {
        std::uint64_t scaled = references_ == 0 ? reference : sizes_ * reference / references_;
        return static_cast<std::int64_t>(std::min<std::uint64_t>(scaled, UINT32_MAX));
    }
    void learn(std::uint64_t reference, std::uint64_t size) {
        references_ += reference - references_ / 4;
        sizes_ += size - sizes_ / 4;
        while (sizes_ >= std::uint64_t{1} << 32) { // keeps the product above within 64 bits
            sizes_ /= 2;
            references_ /= 2;
        }
    }

  private:
    std::uint64_t references_ = 0, sizes_ = 0;
};

// Numbers as a stream of low bytes, which hardly compress, and one of what is above them, which does.
class SplitWriter {
  public:
    void write(std::uint64_t value) {
        lows_.push_back(static_cast<std::uint8_t>(value));
        writeVarint(highs_, value >> 8);
    }
    void finish(ByteWriter& to) {
        writeSection(to, lows_, Effort::thorough);
        writeSection(to, highs_.bytes(), Effort::thorough);
    }

  private:
    Bytes lows_;
    ByteWriter highs_;
};

class SplitReader {
  public:
    // For up to `count` numbers.
    static Result<SplitReader> open(ByteReader& from, std::size_t count) {
        SplitReader reader;
        reader.lows_.resize(count);
        reader.highs_.resize(5 * count); // 33 bits of a zigzag difference less 8 are four groups
        STIPPLE_TRY(lows, readSection(from, reader.lows_));
        STIPPLE_TRY(highs, readSection(from, reader.highs_));
        reader.lows_.resize(lows);
        reader.highs_.resize(highs);
        return reader;
    }
    std::uint64_t next() {
        ByteReader highs(ByteSpan(highs_).subspan(at_));
        std::uint64_t high = readVarint(highs);
        ok_ = ok_ && highs.ok() && low_ < lows_.size() && high < (std::uint64_t{1} << 32);
        at_ += highs.position();
        return ok_ ? high << 8 | lows_[low_++] : 0;
    }
    bool ok() const { return ok_; }
    bool finished() const { return ok_ && low_ == lows_.size() && at_ == highs_.size(); }

  private:
    Bytes lows_, highs_;
    std::size_t low_ = 0, at_ = 0;
    bool ok_ = true;
};

bool validKey(const NodeKey& key) {
    std::uint64_t side = std::uint64_t{1} << std::min<int>(key.level, 32);
    return key.level <= maxLevel && key.x < side && key.y < side && key.z < side;
}

// Sizes without the bits that padding makes zero.
std::int64_t sizeCode(std::int64_t size) {
    constexpr std::int64_t from = paddedFrom, unit = paddedTo;
    return size < from ? size : from + (size - from) / unit;
}
std::int64_t sizeOfCode(std::int64_t code) {
    constexpr std::int64_t from = paddedFrom, unit = paddedTo;
    return code < from ? code : from + (code - from) * unit;
}

// Size column `column` of a node: strata 0…3, then the attribute blocks.
std::uint32_t& sizeOf(NodeEntry& node, std::size_t column) {
    return column < strataCount ? node.strataBytes[column] : node.attributeBytes[column - strataCount];
}

// Every size column, nodes with points only; `visit` is given the size and its prediction, and may set it.
template <class Visit>
void forEachSize(std::vector<NodeEntry>& nodes, std::size_t columns, const Visit& visit) {
    for (std::size_t column = 0; column < columns; ++column) {
        SizeModel model;
        for (NodeEntry& node : nodes)
            if (node.pointCount > 0) {
                bool follows = column > 0 && column < strataCount;
                std::uint64_t reference = follows ? node.strataBytes[column - 1] : node.pointCount;
                std::uint32_t& size = sizeOf(node, column);
                visit(size, model.predict(reference));
                model.learn(reference, size);
            }
    }
}

} // namespace

// [u8 parent level | 255] [u8 parent's child mask] [u16 0] [u32 x y z of the parent] [u32 nodes]
// [u64 data offset] [u64 offset of child chunks]
// [section: u8 child mask of each node]
// [split: points of each node; per size column and node with points the size less its prediction, both as
// codes, zigzag] [split: per node with children the bytes of their chunk, 0 = they are in this one]
Bytes writeHierarchyChunk(const HierarchyChunk& chunk) {
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
    Bytes masks;
    SplitWriter sizes, chunks;
    for (const NodeEntry& node : chunk.nodes) {
        masks.push_back(node.childMask);
        sizes.write(node.pointCount);
        if (node.childMask != 0)
            chunks.write(node.childChunk.size);
    }
    std::vector<NodeEntry> nodes = chunk.nodes;
    forEachSize(nodes, strataCount + nodes[0].attributeBytes.size(),
                [&](std::uint32_t size, std::int64_t predicted) {
                    sizes.write(zigzag(sizeCode(size) - sizeCode(predicted)));
                });
    writeSection(to, masks, Effort::thorough);
    sizes.finish(to);
    chunks.finish(to);
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
        return Error{ErrorCode::truncated, say("the chunk's head ends early"), "hierarchy chunk", {}};
    std::size_t attributeBlockCount = attributeBlocks(metadata).size();
    std::size_t numbersPerNode = 1 + strataCount + attributeBlockCount;
    if (std::uint64_t{nodeCount} * numbersPerNode > maxChunkNumbers)
        return Error{
            ErrorCode::limitExceeded, say("a chunk of ", nodeCount, " nodes"), "hierarchy chunk", {}};
    if (zero != 0 || dataOffset > fileBytes || childChunksOffset > fileBytes)
        return corrupt(say("the chunk's head does not fit the file"));

    Bytes masks(nodeCount);
    STIPPLE_CHECK(readFullSection(from, masks));
    STIPPLE_TRY(sizes, SplitReader::open(from, nodeCount * numbersPerNode));
    STIPPLE_TRY(chunks, SplitReader::open(from, nodeCount));
    if (from.remaining() > 0)
        return corrupt(say("bytes are left over"));

    // Where the nodes are: children follow in the order of their parents.
    std::vector<NodeEntry> nodes;
    nodes.reserve(nodeCount);
    bool fits = true;
    auto append = [&](const NodeKey& key) {
        fits = fits && validKey(key) && nodes.size() < nodeCount;
        if (fits)
            nodes.emplace_back().key = key;
    };
    auto appendChildren = [&](NodeKey of, std::uint8_t mask) {
        for (int c = 0; c < 8 && fits; ++c)
            if ((mask >> c) & 1)
                append(of.child(c));
    };
    if (parent.level == noParent)
        append(NodeKey{});
    else if (fits = validKey(parent) && parent.level < maxLevel; fits)
        appendChildren(parent, parentMask);
    for (std::size_t i = 0; i < nodes.size() && fits; ++i) {
        nodes[i].childMask = masks[i];
        if (masks[i] == 0)
            continue;
        std::uint64_t bytes = chunks.next();
        if (bytes == 0) {
            appendChildren(nodes[i].key, masks[i]);
        } else {
            fits = fits && bytes <= maxChunkBytes && bytes <= fileBytes - childChunksOffset;
            nodes[i].childChunk = {childChunksOffset, bytes};
            childChunksOffset += bytes;
        }
    }
    if (!fits || nodes.size() != nodeCount || !chunks.finished())
        return corrupt(say("the chunk's nodes do not fit the octree"));

    // What they hold.
    auto size32 = [&](std::uint64_t value) {
        fits = fits && value <= UINT32_MAX;
        return fits ? static_cast<std::uint32_t>(value) : 0;
    };
    for (NodeEntry& node : nodes)
        node.pointCount = size32(sizes.next());
    for (NodeEntry& node : nodes)
        node.attributeBytes.resize(attributeBlockCount);
    forEachSize(nodes, strataCount + attributeBlockCount, [&](std::uint32_t& size, std::int64_t predicted) {
        size = size32(static_cast<std::uint64_t>(sizeOfCode(sizeCode(predicted) + unzigzag(sizes.next()))));
    });
    for (NodeEntry& node : nodes) {
        node.offsetBytes = dataOffset;
        fits = fits && node.sizeBytes() <= fileBytes - dataOffset;
        if (!fits)
            break;
        dataOffset += node.sizeBytes();
    }
    if (!fits || !sizes.finished())
        return corrupt(say("the chunk's nodes contradict the size of the file"));
    return nodes;
}

} // namespace stipple
