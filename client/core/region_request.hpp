// What is asked of a region's scan (region_scan.hpp), and what it says.
#pragma once

#include "shared/base/result.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/select/point_filter.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace stipple {

using RegionScanId = std::int32_t;

struct RegionRequest {
    std::uint32_t cloud = 0; // CloudId
    PointFilter filter;
    std::vector<int> attributes; // those of PointChooser::make()
    // Of nodes that are asked for or here, at most; one node is always allowed.
    std::uint64_t bytesAhead = 8ull << 20;
};

// A node that was read, with the bytes that PointChooser::choose() needs.
struct RegionNode {
    NodeBytes node;
    bool tested = true; // false: all its points are wanted
};

struct RegionProgress {
    std::uint64_t nodesDone = 0, pointsDone = 0; // taken; points: of the nodes, before they are tested
    std::uint64_t nodesToDo = 0, pointsToDo = 0; // known by now; there may be more in chunks
    std::uint64_t nodesWhole = 0, nodesOutside = 0,
                  nodesNotWanted = 0; // seen; not wanted: too fine, or no values
    std::uint64_t chunksToDo = 0;
    std::uint64_t bytesRead = 0; // of nodes, what was here already included
    bool hierarchyKnown = false; // toDo and done together are all there is
    bool complete = false;       // every node was taken
    std::optional<Error> error;  // why the scan has ended without
};

} // namespace stipple
