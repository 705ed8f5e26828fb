// The parts of a file as CloudWriter makes them; cloud_file.hpp has the ways back.
#pragma once

#include "shared/format/cloud_file.hpp"

namespace stipple {

// 2: inner nodes may show mean colours.
inline constexpr std::uint32_t latestVersion = 2;
// The lowest version that has what the cloud uses.
inline std::uint32_t versionFor(const CloudMetadata& metadata) {
    return metadata.innerColour == InnerColour::exact ? 1 : 2;
}
// Limits a reader checks before it asks for a block or makes room for what it says.
inline constexpr std::uint64_t maxMetadataBytes = 64 * 1024 * 1024;
inline constexpr std::uint64_t maxChunkBytes = 16 * 1024 * 1024;
inline constexpr std::uint64_t maxChunkNumbers = 1 << 22; // counts and sizes of all nodes of a chunk
inline constexpr std::size_t maxAttributes = 1024;

Bytes writeFileHeader(const FileHeader& header);    // fileHeaderBytes
Bytes writeMetadata(const CloudMetadata& metadata); // framed

// A hierarchy chunk: the nodes below one parent (or the root node alone and what is below it), breadth
// first, down to nodes whose children are in chunks of their own.
struct HierarchyChunk {
    bool isRoot = false;
    NodeKey parent; // unless isRoot
    std::uint8_t parentChildMask = 0;
    // Ranges are relative: a node's blocks follow those of the node before, and child chunks lie one after
    // the other in the order of their parents. Only sizes are read from the entries.
    std::vector<NodeEntry> nodes;
    std::uint64_t dataOffset = 0;        // of the first node's blocks
    std::uint64_t childChunksOffset = 0; // of the first child chunk
};

// The size does not depend on the two offsets, so a file is laid out from the leaves up.
Bytes writeHierarchyChunk(const HierarchyChunk& chunk); // framed

} // namespace stipple
