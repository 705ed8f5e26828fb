// Runs work on octree nodes that depend on their neighbours, in an order that does not depend on the number
// of threads.
//
// Nodes have a fixed rank: by the parity of their coordinates, so that most nodes have no neighbour of the
// same parity, then by key. A node starts when all nodes of lower rank that touch it are done. So what it
// sees of its neighbours is the same for any number of threads, and nodes that do not touch run side by side.
#pragma once

#include "shared/base/result.hpp"
#include "shared/geometry/node_key.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

namespace stipple {

// Whether two nodes (neither inside the other) share a face, an edge or a corner.
bool touches(const NodeKey& a, const NodeKey& b);

struct ScheduledNode {
    NodeKey key;
    std::uint64_t memoryBytes = 0; // that its work takes
    bool done = false;             // already, before the run
};

// For each node the indices of those that touch it and go first. No node is inside another.
std::vector<std::vector<std::size_t>> predecessors(const std::vector<ScheduledNode>& nodes);

// Calls work(index) once for every node that is not done, on up to `threads` threads, while the memory of
// those at work stays within `memoryBytes` (one may always run). After an error nothing more starts; the
// error is returned. Large nodes go first among those that are ready. Running out of memory in `work` is
// outOfMemory; `stop` turning true is cancelled.
Status runScheduled(const std::vector<ScheduledNode>& nodes,
                    const std::vector<std::vector<std::size_t>>& before, int threads,
                    std::uint64_t memoryBytes, const std::atomic<bool>* stop,
                    const std::function<Status(std::size_t index)>& work);

} // namespace stipple
