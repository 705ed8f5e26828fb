// The way from a cloud to a sink: reads the nodes a filter wants and no others, of those the blocks that are
// needed and no others, and hands the points on in the order of the file's hierarchy.
//
// Reading and writing are done by the calling thread; decoding, testing and encoding by all. Memory: what the
// nodes in work take, at most 4 for each thread and, unless one node holds more, about 2 million points.
#pragma once

#include "shared/base/work_gate.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/select/cloud_filter.hpp"
#include "shared/sinks/point_sink.hpp"

#include <array>
#include <functional>

namespace stipple {

// Nodes, with what they hold.
struct NodeTally {
    std::uint64_t nodes = 0, points = 0, bytes = 0;

    void add(const NodeEntry& entry) {
        ++nodes;
        points += entry.pointCount;
        bytes += entry.sizeBytes();
    }
    friend bool operator==(const NodeTally&, const NodeTally&) = default;
};

// Of one level: the points taken, and the nodes that they are of.
struct LevelTally {
    std::uint64_t nodes = 0, points = 0;
};

// What was done and what was not needed. Nodes whose hierarchy chunk was not read are in no tally but
// in hierarchy.chunksSkipped.
struct WalkCounters {
    NodeTally whole;                  // read, every point taken without a test
    NodeTally tested;                 // read, point by point
    NodeTally outside;                // not read: no point of it in the region
    NodeTally finer;                  // not read: finer than the spacing asked for
    NodeTally absent;                 // not read: no point of the cloud has the attribute values asked for
    CloudFilter::Dropped dropped;     // points of tested nodes
    std::uint64_t droppedByLimit = 0; // points of nodes read
    std::uint64_t pointsTaken = 0;
    std::array<LevelTally, maxLevel + 1> levels{}; // of pointsTaken
    std::uint64_t bytesRead = 0;                   // of nodes
    std::uint64_t attributeBytesSkipped = 0;       // blocks of nodes read whose attributes nobody asked for
    HierarchyCounters hierarchy;
};

struct WalkOptions {
    int threads = 1;
    // Of the points wanted, the first so many in the order of the file (coarse nodes come first); 0: all.
    // Nodes behind them are not read, but for a few that were begun already.
    std::uint64_t limit = 0;
    // Once closed, the walk ends with `cancelled`, before another piece of points is decoded, tested or
    // written (WorkGate::pieceItems for each thread).
    const WorkGate* gate = nullptr;
    // Points of the nodes done with. Called on the calling thread.
    std::function<void(std::uint64_t points)> progress = nullptr;
};

// `attributes`: those the sink takes, in its order; behind the cloud's own, station and offset where the
// filter has a corridor (corridor_attributes.hpp). Does not finish the sink. Errors: those of the reader
// (with the node and the file's name, `name`) and of the sink.
Result<WalkCounters> walkPoints(CloudReader& reader, const std::string& name, const CloudFilter& filter,
                                const std::vector<int>& attributes, PointSink& sink,
                                const WalkOptions& options);

// How many points walkPoints() would take, without reading more than that needs.
Result<std::uint64_t> countPoints(CloudReader& reader, const std::string& name, const CloudFilter& filter,
                                  const WalkOptions& options);

// At least as many, told by the hierarchy alone: all points of the nodes that have to be read. Tells what a
// walk would cost.
Result<NodeTally> tallyNodes(CloudReader& reader, const CloudFilter& filter, const WalkOptions& options);

} // namespace stipple
