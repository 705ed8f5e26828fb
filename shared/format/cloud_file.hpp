// The parts of a `.stipple` file, parsed from bytes: pure functions, safe on untrusted input, for readers
// that fetch ranges themselves (client/core), and CloudReader for programs that read a whole file.
#pragma once

#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/format/cloud_writer.hpp"
#include "shared/format/node_entry.hpp"
#include "shared/format/node_points.hpp"
#include "shared/io/byte_source.hpp"
#include "shared/points/point_batch.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace stipple {

inline constexpr std::uint64_t firstRequestBytes = 64 * 1024; // what a client asks for first

// The fixed-size header.
struct FileHeader {
    std::uint64_t fileBytes = 0; // of the complete file
    ByteRange metadata;
    ByteRange rootChunk;
};
inline constexpr std::size_t fileHeaderBytes = 64;

Result<FileHeader> parseFileHeader(ByteSpan bytes);  // at least fileHeaderBytes
Result<CloudMetadata> parseMetadata(ByteSpan block); // exactly FileHeader::metadata
// The nodes of a hierarchy chunk, breadth first. Every entry's ranges lie inside `fileBytes`.
Result<std::vector<NodeEntry>> parseHierarchyChunk(const CloudMetadata& metadata, std::uint64_t fileBytes,
                                                   ByteSpan block);

// Decodes the first `strata` strata (1..4) from their bytes (exactly entry.strataRange(strata)). Errors of
// this and of decodeAttributes name the node, the block and its byte. Memory: bounded by entry.pointCount,
// which is itself bounded by the bytes that came.
Result<NodePicture> decodePicture(const CloudMetadata& metadata, const NodeEntry& entry, int strata,
                                  ByteSpan bytes);
// Decodes further block `block` for all points of the node (exactly entry.attributeRange(block)):
// one column of raw little-endian values per attribute of the block, in progressive order.
Result<std::vector<Bytes>> decodeAttributes(const CloudMetadata& metadata, const NodeEntry& entry,
                                            std::size_t block, ByteSpan bytes);

// A whole file through a byte source, waiting for each read; for converters and tests.
class CloudReader {
  public:
    static Result<std::unique_ptr<CloudReader>> open(ByteSource& source); // source outlives the reader
    virtual ~CloudReader() = default;

    virtual const FileHeader& header() const = 0;
    virtual const CloudMetadata& metadata() const = 0;
    // Every node, chunk by chunk; stops at the first error, the visitor's own included.
    virtual Status visitNodes(const std::function<Status(const NodeEntry&)>& visit) = 0;
    // All points of a node, grid integers and every attribute of the schema. Errors name the file and, where
    // the bytes could be read, the node.
    virtual Result<PointBatch> readNode(const NodeEntry& entry) = 0;
};

} // namespace stipple
