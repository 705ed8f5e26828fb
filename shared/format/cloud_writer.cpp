#include "shared/format/cloud_writer.hpp"

#include "shared/base/text.hpp"
#include "shared/format/block_frame.hpp"
#include "shared/format/file_parts.hpp"
#include "shared/format/hierarchy_layout.hpp"
#include "shared/io/output_file.hpp"

#include <algorithm>

namespace stipple {

namespace {
Status check(const std::string& path, const CloudMetadata& metadata, const std::vector<StoredNode>& nodes,
             std::size_t attributeBlockCount) {
    std::uint64_t points = 0;
    for (const StoredNode& node : nodes) {
        points += node.pointCount;
        if (node.attributeBytes.size() != attributeBlockCount)
            return Error{ErrorCode::invalidArgument, "a node was encoded for another schema", path, {}};
    }
    if (points != metadata.pointCount)
        return Error{ErrorCode::invalidArgument,
                     cat("the nodes have ", points, " points, but the metadata say ", metadata.pointCount),
                     path,
                     {}};
    return {};
}

std::vector<HierarchyChunk> describeChunks(const std::vector<OctreeNode>& octree,
                                           const std::vector<ChunkPlan>& plans,
                                           const std::vector<StoredNode>& nodes,
                                           std::size_t attributeBlockCount) {
    std::vector<HierarchyChunk> chunks;
    for (const ChunkPlan& plan : plans) {
        HierarchyChunk& chunk = chunks.emplace_back();
        chunk.isRoot = plan.parent < 0;
        if (!chunk.isRoot) {
            chunk.parent = octree[static_cast<std::size_t>(plan.parent)].key;
            chunk.parentChildMask = octree[static_cast<std::size_t>(plan.parent)].childMask;
        }
        for (std::size_t i : plan.nodes) {
            NodeEntry& entry = chunk.nodes.emplace_back();
            entry.key = octree[i].key;
            entry.childMask = octree[i].childMask;
            entry.attributeBytes.resize(attributeBlockCount);
            if (octree[i].source >= 0) {
                const StoredNode& stored = nodes[static_cast<std::size_t>(octree[i].source)];
                entry.pointCount = stored.pointCount;
                entry.strataBytes = stored.strataBytes;
                entry.attributeBytes = stored.attributeBytes;
            }
        }
    }
    return chunks;
}

// Sizes from the last chunk to the first (a chunk states those of its children), then offsets from the
// first to the last: header, metadata, root chunk, all nodes chunk by chunk, all other chunks.
std::vector<Bytes> placeChunks(FileHeader& header, const std::vector<ChunkPlan>& plans,
                               std::vector<HierarchyChunk>& chunks) {
    std::vector<Bytes> blocks(chunks.size());
    std::uint64_t otherChunksBytes = 0;
    for (std::size_t c = chunks.size(); c-- > 0;) {
        std::size_t child = plans[c].firstChildChunk;
        for (NodeEntry& entry : chunks[c].nodes)
            if (child < chunks.size() && chunks[child].parent == entry.key)
                entry.childChunk.size = blocks[child++].size();
        blocks[c] = writeHierarchyChunk(chunks[c]);
        otherChunksBytes += c > 0 ? blocks[c].size() : 0;
    }
    header.rootChunk.size = blocks[0].size();
    std::uint64_t at = header.rootChunk.end();
    for (HierarchyChunk& chunk : chunks) {
        chunk.dataOffset = at;
        for (const NodeEntry& entry : chunk.nodes)
            at += entry.sizeBytes();
    }
    header.fileBytes = at + otherChunksBytes;
    std::vector<std::uint64_t> chunkOffsets(chunks.size() + 1, at);
    for (std::size_t c = 1; c < chunks.size(); ++c)
        chunkOffsets[c + 1] = chunkOffsets[c] + blocks[c].size();
    for (std::size_t c = 0; c < chunks.size(); ++c) {
        chunks[c].childChunksOffset = chunkOffsets[plans[c].firstChildChunk];
        blocks[c] = writeHierarchyChunk(chunks[c]);
    }
    return blocks;
}

Status copyNodes(OutputFile& file, const ScratchFile& blocks, const std::vector<StoredNode>& nodes,
                 const std::vector<OctreeNode>& octree, const std::vector<ChunkPlan>& plans,
                 const std::atomic<bool>* stop, WrittenCloud& written) {
    Bytes buffer;
    for (const ChunkPlan& plan : plans)
        for (std::size_t i : plan.nodes) {
            if (octree[i].source < 0)
                continue;
            if (stop && *stop)
                return Error{ErrorCode::cancelled, "interrupted", "", ""};
            const StoredNode& stored = nodes[static_cast<std::size_t>(octree[i].source)];
            buffer.resize(static_cast<std::size_t>(stored.sizeBytes()));
            STIPPLE_CHECK(blocks.read(stored.offset, buffer));
            STIPPLE_CHECK(file.append(buffer));
            std::uint64_t attributeBytes = 0;
            for (std::uint32_t bytes : stored.attributeBytes)
                attributeBytes += bytes;
            written.attributeBytes += attributeBytes;
            written.pictureBytes += stored.sizeBytes() - attributeBytes;
        }
    return {};
}

} // namespace

std::uint64_t StoredNode::sizeBytes() const {
    std::uint64_t size = 0;
    for (std::uint32_t bytes : strataBytes)
        size += bytes;
    for (std::uint32_t bytes : attributeBytes)
        size += bytes;
    return size;
}

Result<StoredNode> storeNode(const EncodedNode& node, ScratchFile& blocks) {
    std::string where = "node " + node.key.text();
    if (node.key.level > maxLevel)
        return Error{ErrorCode::invalidArgument, "the node is deeper than the deepest level", where, {}};
    auto unpadded = [](const Bytes& block) {
        return block.size() >= paddedFrom && block.size() % paddedTo != 0;
    };
    if (std::any_of(node.strata.begin(), node.strata.end(), unpadded) ||
        std::any_of(node.attributes.begin(), node.attributes.end(), unpadded))
        return Error{ErrorCode::invalidArgument, "a block of the node is not padded", where, {}};
    StoredNode stored;
    stored.key = node.key;
    stored.pointCount = node.pointCount;
    for (std::size_t s = 0; s < strataCount; ++s)
        stored.strataBytes[s] = static_cast<std::uint32_t>(node.strata[s].size());
    for (const Bytes& block : node.attributes)
        stored.attributeBytes.push_back(static_cast<std::uint32_t>(block.size()));
    stored.offset = blocks.reserve(stored.sizeBytes());
    std::uint64_t at = stored.offset;
    auto write = [&](const Bytes& block) {
        Status written = blocks.write(at, block);
        at += block.size();
        return written;
    };
    for (const Bytes& block : node.strata)
        STIPPLE_CHECK(write(block));
    for (const Bytes& block : node.attributes)
        STIPPLE_CHECK(write(block));
    return stored;
}

Result<WrittenCloud> assembleCloud(const std::string& path, const CloudMetadata& metadata,
                                   const std::vector<StoredNode>& nodes, const ScratchFile& blocks,
                                   const std::atomic<bool>* stop) {
    std::size_t attributeBlockCount = attributeBlocks(metadata).size();
    STIPPLE_CHECK(check(path, metadata, nodes, attributeBlockCount));
    std::vector<NodeKey> keys;
    for (const StoredNode& node : nodes)
        keys.push_back(node.key);
    std::vector<OctreeNode> octree = completeOctree(keys);
    std::vector<ChunkPlan> plans = planChunks(octree);
    std::vector<HierarchyChunk> chunks = describeChunks(octree, plans, nodes, attributeBlockCount);

    Bytes metadataBlock = writeMetadata(metadata);
    if (metadataBlock.size() > maxMetadataBytes)
        return Error{ErrorCode::limitExceeded, "the metadata are over 64 MB", path, {}};
    FileHeader header;
    header.version = versionFor(metadata);
    header.metadata = {fileHeaderBytes, metadataBlock.size()};
    header.rootChunk = {header.metadata.end(), 0};
    std::vector<Bytes> chunkBlocks = placeChunks(header, plans, chunks);

    STIPPLE_TRY(file, OutputFile::create(path));
    STIPPLE_CHECK(file->append(writeFileHeader(header)));
    STIPPLE_CHECK(file->append(metadataBlock));
    STIPPLE_CHECK(file->append(chunkBlocks[0]));
    WrittenCloud written;
    STIPPLE_CHECK(copyNodes(*file, blocks, nodes, octree, plans, stop, written));
    for (std::size_t c = 1; c < chunkBlocks.size(); ++c)
        STIPPLE_CHECK(file->append(chunkBlocks[c]));
    STIPPLE_CHECK(file->commit());

    written.fileBytes = header.fileBytes;
    written.metadataBytes = metadataBlock.size();
    for (const Bytes& block : chunkBlocks)
        written.hierarchyBytes += block.size();
    written.nodes = octree.size();
    written.chunks = chunks.size();
    return written;
}

Result<std::unique_ptr<CloudWriter>> CloudWriter::create(const std::string& path) {
    STIPPLE_TRY(blocks, ScratchFile::create(path + ".blocks"));
    return std::unique_ptr<CloudWriter>(new CloudWriter(path, std::move(blocks)));
}

Status CloudWriter::add(const EncodedNode& node) {
    if (!blocks_)
        return Error{ErrorCode::invalidArgument, "the file is finished already", path_, {}};
    if (!added_.insert(node.key).second)
        return Error{ErrorCode::invalidArgument, "the node was added before", "node " + node.key.text(), {}};
    STIPPLE_TRY(stored, storeNode(node, *blocks_));
    stored_.push_back(std::move(stored));
    return {};
}

Result<WrittenCloud> CloudWriter::finish(const CloudMetadata& metadata) {
    if (!blocks_)
        return Error{ErrorCode::invalidArgument, "the file is finished already", path_, {}};
    STIPPLE_TRY(written, assembleCloud(path_, metadata, stored_, *blocks_));
    blocks_.reset();
    return std::move(written);
}

} // namespace stipple
