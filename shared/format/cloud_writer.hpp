// Writes one `.stipple` file from finished nodes. Encoding a node is a pure function (encodeNode) that any
// thread may run; the writer lays the blocks out and writes header, metadata and hierarchy around them.
#pragma once

#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/format/node_entry.hpp"
#include "shared/points/point_batch.hpp"

#include <memory>
#include <string>
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
};
// The blocks of every node of a cloud, in file order: all attributes that are not part of the picture.
std::vector<AttributeBlock> attributeBlocks(const CloudMetadata& metadata);

// Encodes the points of one node, given in grid integers in any order (which is not kept: points are stored
// in progressive order; the same multiset gives the same bytes). Errors: outOfRange if a point lies
// outside the node; invalidArgument if the node is wider than 2^31 steps.
Result<EncodedNode> encodeNode(const CloudMetadata& metadata, NodeKey key, const PointBatch& points);

struct WrittenCloud {
    std::uint64_t fileBytes = 0, pictureBytes = 0, attributeBytes = 0, hierarchyBytes = 0, metadataBytes = 0;
    std::uint64_t nodes = 0, chunks = 0;
};

class CloudWriter {
  public:
    // `path` gets its name only when finish() succeeds; until then the blocks wait in a temporary file
    // beside it.
    static Result<std::unique_ptr<CloudWriter>> create(const std::string& path);
    virtual ~CloudWriter() = default; // without finish(): removes what was written

    // Takes a node, in any order, each key once; nodes without points need not be added (the tree above
    // an added node is completed). Thread: one at a time.
    virtual Status add(const EncodedNode& node) = 0;
    // Orders and writes everything. `metadata` is final here (statistics, hash, counts).
    virtual Result<WrittenCloud> finish(const CloudMetadata& metadata) = 0;
};

} // namespace stipple
