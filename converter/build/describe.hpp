// What a `.stipple` file holds and where its bytes go.
#pragma once

#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/io/byte_source.hpp"

#include <string>
#include <vector>

namespace stipple {

struct LevelSummary {
    std::uint64_t nodes = 0, points = 0, bytes = 0;
    std::uint32_t smallestNode = 0, largestNode = 0; // points of nodes that have any
};

struct PartSummary {
    std::string name; // "positions", "colour", or the names of a block's attributes
    std::uint64_t bytes = 0;
};

struct CloudSummary {
    CloudMetadata metadata;
    std::uint64_t fileBytes = 0, metadataBytes = 0, nodes = 0, nodeBytes = 0;
    std::uint64_t hierarchyBytes = 0; // what is neither header, metadata nor node
    std::vector<LevelSummary> levels; // by level, the root's first
    std::vector<PartSummary> parts;   // "picture" first, then the blocks in file order
};

// Reads header, metadata and the whole hierarchy. With `splitPicture` also every node's picture, to tell the
// bytes of positions from those of colour ("positions" and "colour" in place of "picture").
Result<CloudSummary> describeCloud(ByteSource& source, bool splitPicture);

} // namespace stipple
