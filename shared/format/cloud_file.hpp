// The parts of a `.stipple` file, parsed from bytes: pure functions, safe on untrusted input, for readers
// that fetch ranges themselves (client/core), and CloudReader for programs that read a whole file.
#pragma once

#include "shared/base/result.hpp"
#include "shared/base/work_gate.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/format/cloud_writer.hpp"
#include "shared/format/node_entry.hpp"
#include "shared/format/node_points.hpp"
#include "shared/io/byte_source.hpp"
#include "shared/points/point_batch.hpp"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace stipple {

inline constexpr std::uint64_t firstRequestBytes = 64 * 1024; // what a client asks for first

// The fixed-size header.
struct FileHeader {
    std::uint64_t fileBytes = 0; // of the complete file
    ByteRange metadata;
    ByteRange rootChunk;
    std::uint32_t version = 1; // of the format
};
inline constexpr std::size_t fileHeaderBytes = 64;

Result<FileHeader> parseFileHeader(ByteSpan bytes);  // at least fileHeaderBytes
Result<CloudMetadata> parseMetadata(ByteSpan block); // exactly FileHeader::metadata
// Metadata that speak of what the header's version does not have are corrupt.
Status checkVersion(const FileHeader& header, const CloudMetadata& metadata);
// The nodes of a hierarchy chunk, breadth first. Every entry's ranges lie inside `fileBytes`.
Result<std::vector<NodeEntry>> parseHierarchyChunk(const CloudMetadata& metadata, std::uint64_t fileBytes,
                                                   ByteSpan block);

// Which nodes a hierarchy chunk is about.
struct ChunkPlace {
    ByteRange range;
    NodeKey parent;                   // whose children begin the chunk
    std::uint8_t parentChildMask = 0; // 0: the root chunk, which begins with the root
};
inline ChunkPlace rootChunkPlace(const FileHeader& header) {
    return {header.rootChunk, NodeKey{}, 0};
}
// Of the children of `entry`, if they are in a chunk of their own (entry.childChunk.size > 0).
inline ChunkPlace childChunkPlace(const NodeEntry& entry) {
    return {entry.childChunk, entry.key, entry.childMask};
}
// Reads and parses a chunk, waiting, and checks that it is about the nodes expected. Errors name the byte.
Result<std::vector<NodeEntry>> readHierarchyChunk(ByteSource& source, const FileHeader& header,
                                                  const CloudMetadata& metadata, const ChunkPlace& place);

// Decodes the first `strata` strata (1..4) from their bytes (exactly entry.strataRange(strata)). Errors of
// this and of decodeAttributes name the node, the block and its byte. Memory: bounded by entry.pointCount,
// which is itself bounded by the bytes that came. All three end with `cancelled` once the gate is closed; the
// bytes of a section (a byte a point at most) are decompressed in one go.
Result<NodePicture> decodePicture(const CloudMetadata& metadata, const NodeEntry& entry, int strata,
                                  ByteSpan bytes, const WorkGate* gate = nullptr);
// Decodes further block `block` for all points of the node (exactly entry.attributeRange(block)):
// one column of raw little-endian values per attribute of the block, in progressive order.
Result<std::vector<Bytes>> decodeAttributes(const CloudMetadata& metadata, const NodeEntry& entry,
                                            std::size_t block, ByteSpan bytes,
                                            const WorkGate* gate = nullptr);

// Replaces the colours of a node's picture, of any number of strata, by the exact ones, from the bytes of the
// block that has them (AttributeBlock::isExactColour; block 0). No bytes: the picture's are exact.
Status decodeExactColour(const CloudMetadata& metadata, const NodeEntry& entry, ByteSpan bytes,
                         NodePicture& picture, const WorkGate* gate = nullptr);

// The bytes of a node that some of its attributes need: the strata (positions and the colour of the picture,
// which travel with them) and the further blocks that hold the attributes asked for.
struct NodeBytes {
    NodeEntry entry;
    std::vector<int> attributes; // indices into metadata.schema.attributes, as asked
    Bytes bytes;                 // of the blocks, in file order, without what lies between them
    int strata = strataCount;    // 1..4: how many of them `bytes` begins with
};
// Which blocks those are: indices into attributeBlocks(metadata), ascending.
std::vector<std::size_t> blocksHolding(const CloudMetadata& metadata, std::span<const int> attributes);
// The points of the node's strata in progressive order, grid integers and one column per attribute asked for
// (batch.columns[i] is NodeBytes::attributes[i]). Pure: any thread. Errors name the node. `cancelled` once
// the gate is closed, before another piece of points (WorkGate::pieceItems) is handled.
Result<PointBatch> decodeNode(const CloudMetadata& metadata, const NodeBytes& node,
                              const WorkGate* gate = nullptr);

// What a walk over the hierarchy read of it, and what it left alone.
struct HierarchyCounters {
    std::uint64_t chunksRead = 0, bytesRead = 0;
    std::uint64_t chunksSkipped = 0, bytesSkipped = 0; // directly below the nodes that were not wanted
};

// A whole file through a byte source, waiting for each read; for converters and tests.
class CloudReader {
  public:
    static Result<std::unique_ptr<CloudReader>> open(ByteSource& source); // source outlives the reader
    // Over a file whose header and metadata are known already; reads nothing.
    static std::unique_ptr<CloudReader> over(ByteSource& source, const FileHeader& header,
                                             CloudMetadata metadata);
    virtual ~CloudReader() = default;

    virtual const FileHeader& header() const = 0;
    virtual const CloudMetadata& metadata() const = 0;
    // Nodes chunk by chunk; stops at the first error, the visitor's own included. `visit` answers whether
    // anything below the node is wanted: where it is not, the hierarchy chunk below is not read. (Nodes below
    // that lie in a chunk that was read are visited all the same; they cost nothing.) Once `*isEnough` is
    // true, nothing further is visited or read.
    virtual Result<HierarchyCounters> visitWanted(const std::function<Result<bool>(const NodeEntry&)>& visit,
                                                  const bool* isEnough = nullptr) = 0;
    // The nodes of one chunk.
    virtual Result<std::vector<NodeEntry>> readChunk(const ChunkPlace& place) = 0;
    // Every node.
    Status visitNodes(const std::function<Status(const NodeEntry&)>& visit);
    // Reads what decodeNode() needs for some attributes, and no other byte of the node.
    virtual Result<NodeBytes> fetchNode(const NodeEntry& entry, std::span<const int> attributes) = 0;
    // All points of a node, grid integers and every attribute of the schema. Errors name the file and, where
    // the bytes could be read, the node.
    Result<PointBatch> readNode(const NodeEntry& entry);

  protected:
    virtual std::string sourceName() const = 0;
};

} // namespace stipple
