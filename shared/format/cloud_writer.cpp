#include "shared/format/cloud_writer.hpp"

#include "shared/base/text.hpp"
#include "shared/format/block_frame.hpp"
#include "shared/format/file_parts.hpp"
#include "shared/format/hierarchy_layout.hpp"
#include "shared/io/output_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <unordered_set>

namespace stipple {

namespace {

// Where blocks wait until their order is known; removed with the object. Errors say its name and the system's
// reason.
class BlockStore {
  public:
    explicit BlockStore(std::string path) : path_(std::move(path)), file_(std::fopen(path_.c_str(), "w+b")) {}
    BlockStore(const BlockStore&) = delete;
    BlockStore& operator=(const BlockStore&) = delete;
    ~BlockStore() {
        if (file_ == nullptr)
            return;
        std::fclose(file_);
        std::remove(path_.c_str());
    }

    Status opened() const {
        if (file_ == nullptr)
            return failure("cannot be created");
        return {};
    }
    Status write(ByteSpan bytes) {
        if (!bytes.empty() && std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size())
            return failure("cannot be written");
        size_ += bytes.size();
        return {};
    }
    Status read(std::uint64_t offset, std::span<std::uint8_t> to) {
        if (!to.empty() && (fseeko(file_, static_cast<off_t>(offset), SEEK_SET) != 0 ||
                            std::fread(to.data(), 1, to.size(), file_) != to.size()))
            return failure("cannot be read back");
        return {};
    }
    std::uint64_t size() const { return size_; }

  private:
    Error failure(const std::string& what) const {
        std::string reason = errno != 0 ? std::strerror(errno) : "unknown reason";
        return Error{ErrorCode::writeFailed, cat("the file ", what, ": ", reason), path_,
                     errno == ENOSPC ? "free some space" : ""};
    }

    std::string path_;
    std::FILE* file_;
    std::uint64_t size_ = 0;
};

// What is remembered of a node until the end; its bytes wait in the temporary file.
struct StoredNode {
    std::uint32_t pointCount = 0;
    std::array<std::uint32_t, strataCount> strataBytes{};
    std::vector<std::uint32_t> attributeBytes;
    std::uint64_t offset = 0; // in the temporary file
    std::size_t size = 0;
};

class Writer final : public CloudWriter {
  public:
    explicit Writer(const std::string& path)
        : path_(path), blocks_(std::make_unique<BlockStore>(path + ".blocks")) {}

    Status opened() const { return blocks_->opened(); }

    Status add(const EncodedNode& node) override {
        if (node.key.level > maxLevel)
            return Error{ErrorCode::invalidArgument,
                         "the node is deeper than the deepest level",
                         "node " + node.key.text(),
                         {}};
        if (!added_.insert(node.key).second)
            return Error{
                ErrorCode::invalidArgument, "the node was added before", "node " + node.key.text(), {}};
        auto unpadded = [](const Bytes& block) {
            return block.size() >= paddedFrom && block.size() % paddedTo != 0;
        };
        if (std::any_of(node.strata.begin(), node.strata.end(), unpadded) ||
            std::any_of(node.attributes.begin(), node.attributes.end(), unpadded))
            return Error{ErrorCode::invalidArgument,
                         "a block of the node is not padded",
                         "node " + node.key.text(),
                         {}};
        StoredNode stored;
        stored.pointCount = node.pointCount;
        stored.offset = blocks_->size();
        for (std::size_t s = 0; s < strataCount; ++s) {
            stored.strataBytes[s] = static_cast<std::uint32_t>(node.strata[s].size());
            STIPPLE_CHECK(blocks_->write(node.strata[s]));
        }
        for (const Bytes& block : node.attributes) {
            stored.attributeBytes.push_back(static_cast<std::uint32_t>(block.size()));
            STIPPLE_CHECK(blocks_->write(block));
        }
        stored.size = static_cast<std::size_t>(blocks_->size() - stored.offset);
        keys_.push_back(node.key);
        stored_.push_back(std::move(stored));
        return {};
    }

    Result<WrittenCloud> finish(const CloudMetadata& metadata) override {
        STIPPLE_CHECK(check(metadata));
        std::size_t attributeBlockCount = attributeBlocks(metadata).size();
        std::vector<OctreeNode> octree = completeOctree(keys_);
        std::vector<ChunkPlan> plans = planChunks(octree);
        std::vector<HierarchyChunk> chunks = describeChunks(octree, plans, attributeBlockCount);

        Bytes metadataBlock = writeMetadata(metadata);
        if (metadataBlock.size() > maxMetadataBytes)
            return Error{ErrorCode::limitExceeded, "the metadata are over 64 MB", path_, {}};
        FileHeader header;
        header.metadata = {fileHeaderBytes, metadataBlock.size()};
        header.rootChunk = {header.metadata.end(), 0};
        std::vector<Bytes> chunkBlocks = placeChunks(header, plans, chunks);

        STIPPLE_TRY(file, OutputFile::create(path_));
        STIPPLE_CHECK(file->append(writeFileHeader(header)));
        STIPPLE_CHECK(file->append(metadataBlock));
        STIPPLE_CHECK(file->append(chunkBlocks[0]));
        WrittenCloud written;
        STIPPLE_CHECK(copyNodes(*file, octree, plans, written));
        for (std::size_t c = 1; c < chunkBlocks.size(); ++c)
            STIPPLE_CHECK(file->append(chunkBlocks[c]));
        STIPPLE_CHECK(file->commit());
        blocks_.reset();

        written.fileBytes = header.fileBytes;
        written.metadataBytes = metadataBlock.size();
        for (const Bytes& block : chunkBlocks)
            written.hierarchyBytes += block.size();
        written.nodes = octree.size();
        written.chunks = chunks.size();
        return written;
    }

  private:
    Status check(const CloudMetadata& metadata) const {
        if (!blocks_)
            return Error{ErrorCode::invalidArgument, "the file is finished already", path_, {}};
        std::size_t attributeBlockCount = attributeBlocks(metadata).size();
        std::uint64_t points = 0;
        for (const StoredNode& node : stored_) {
            points += node.pointCount;
            if (node.attributeBytes.size() != attributeBlockCount)
                return Error{ErrorCode::invalidArgument, "a node was encoded for another schema", path_, {}};
        }
        if (points != metadata.pointCount)
            return Error{
                ErrorCode::invalidArgument,
                cat("the nodes have ", points, " points, but the metadata say ", metadata.pointCount),
                path_,
                {}};
        return {};
    }

    std::vector<HierarchyChunk> describeChunks(const std::vector<OctreeNode>& octree,
                                               const std::vector<ChunkPlan>& plans,
                                               std::size_t attributeBlockCount) const {
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
                    const StoredNode& stored = stored_[static_cast<std::size_t>(octree[i].source)];
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
    static std::vector<Bytes> placeChunks(FileHeader& header, const std::vector<ChunkPlan>& plans,
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

    Status copyNodes(OutputFile& file, const std::vector<OctreeNode>& octree,
                     const std::vector<ChunkPlan>& plans, WrittenCloud& written) {
        Bytes buffer;
        for (const ChunkPlan& plan : plans)
            for (std::size_t i : plan.nodes) {
                if (octree[i].source < 0)
                    continue;
                const StoredNode& stored = stored_[static_cast<std::size_t>(octree[i].source)];
                buffer.resize(stored.size);
                STIPPLE_CHECK(blocks_->read(stored.offset, buffer));
                STIPPLE_CHECK(file.append(buffer));
                std::uint64_t attributeBytes = 0;
                for (std::uint32_t bytes : stored.attributeBytes)
                    attributeBytes += bytes;
                written.attributeBytes += attributeBytes;
                written.pictureBytes += stored.size - attributeBytes;
            }
        return {};
    }

    std::string path_;
    std::unique_ptr<BlockStore> blocks_;
    std::unordered_set<NodeKey, NodeKeyHash> added_;
    std::vector<NodeKey> keys_;
    std::vector<StoredNode> stored_;
};

} // namespace

Result<std::unique_ptr<CloudWriter>> CloudWriter::create(const std::string& path) {
    auto writer = std::make_unique<Writer>(path);
    STIPPLE_CHECK(writer->opened());
    return std::unique_ptr<CloudWriter>(std::move(writer));
}

} // namespace stipple
