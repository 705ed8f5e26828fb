// Writes one `.stipple` file from finished nodes. Encoding a node is a pure function (encodeNode) that any
// thread may run; storeNode puts its blocks aside; assembleCloud lays them out and writes header, metadata
// and hierarchy around them.
#pragma once

#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/format/node_entry.hpp"
#include "shared/io/scratch_file.hpp"
#include "shared/points/point_batch.hpp"

#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <unordered_set>
#include <vector>

namespace stipple {

struct EncodedNode {
    NodeKey key;
    std::uint32_t pointCount = 0;
    std::array<Bytes, strataCount> strata;
    std::vector<Bytes> attributes; // blocks in the order of attributeBlocks(metadata)
};

// A further block of a node: one attribute, or a few that are always wanted together.
struct AttributeBlock {
    std::vector<int> attributes; // indices into metadata.schema.attributes
    // The exact colours, of which the picture shows others: decoded by decodeExactColour, not as attributes.
    bool isExactColour = false;
};
// The blocks of every node of a cloud, in file order: the exact colours, if pictures may show others, and all
// attributes that are not part of the picture.
std::vector<AttributeBlock> attributeBlocks(const CloudMetadata& metadata);

// Encodes the points of one node, given in grid integers in any order (which is not kept: points are stored
// in progressive order; the same multiset gives the same bytes). `shown`, for clouds whose inner nodes show
// mean colours: what the picture is to show of each point, in the channels of the picture, interleaved;
// empty: their own colours. It is rounded to the precision of those, and to 8 bits where they have 16.
// Errors: outOfRange if a point lies outside the node; invalidArgument if the node is wider than 2^31 steps.
Result<EncodedNode> encodeNode(const CloudMetadata& metadata, NodeKey key, const PointBatch& points,
                               std::span<const std::uint16_t> shown = {});

struct WrittenCloud {
    std::uint64_t fileBytes = 0, pictureBytes = 0, attributeBytes = 0, hierarchyBytes = 0, metadataBytes = 0;
    std::uint64_t nodes = 0, chunks = 0;
};

// What is remembered of a node until the file is assembled; its bytes wait in a scratch file.
struct StoredNode {
    NodeKey key;
    std::uint32_t pointCount = 0;
    std::array<std::uint32_t, strataCount> strataBytes{};
    std::vector<std::uint32_t> attributeBytes;
    std::uint64_t offset = 0; // of stratum 0 in the scratch file; the other blocks follow

    std::uint64_t sizeBytes() const;
};

// Appends a node's blocks to `blocks`. Thread: any. invalidArgument for a node deeper than maxLevel or with
// blocks that are not padded.
Result<StoredNode> storeNode(const EncodedNode& node, ScratchFile& blocks);

// Writes the file: orders the nodes (any order, each key once; those without points need not be there, the
// tree above a node is completed), lays them out and copies their blocks. `path` gets its name when all is
// written. `metadata` is final here (statistics, hash, counts). `cancelled` once `stop` is true.
Result<WrittenCloud> assembleCloud(const std::string& path, const CloudMetadata& metadata,
                                   const std::vector<StoredNode>& nodes, const ScratchFile& blocks,
                                   const std::atomic<bool>* stop = nullptr);

// Both in one, for clouds that are made in one go.
class CloudWriter {
  public:
    // Until finish() the blocks wait in a temporary file beside `path`.
    static Result<std::unique_ptr<CloudWriter>> create(const std::string& path);

    // Thread: one at a time.
    Status add(const EncodedNode& node);
    Result<WrittenCloud> finish(const CloudMetadata& metadata);

  private:
    CloudWriter(std::string path, std::unique_ptr<ScratchFile> blocks)
        : path_(std::move(path)), blocks_(std::move(blocks)) {}

    std::string path_;
    std::unique_ptr<ScratchFile> blocks_; // null once the file is finished
    std::unordered_set<NodeKey, NodeKeyHash> added_;
    std::vector<StoredNode> stored_;
};

} // namespace stipple
