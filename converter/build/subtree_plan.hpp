// Which subtrees a cloud is built in: the largest octree nodes of no more points than are worked on at once.
// Depends on the points alone, not on memory or threads.
#pragma once

#include "converter/build/tile.hpp"

namespace stipple {

// Rows that wait in a cell.
struct CellRef {
    RowStore* store = nullptr;
    std::size_t cell = 0;
};

struct PlannedSubtree {
    NodeKey key;
    std::uint64_t points = 0;
    std::vector<CellRef> cells; // that hold its points, and no others
};

struct SubtreePlan {
    std::vector<PlannedSubtree> subtrees;          // in Morton order; every point in one of them
    std::vector<std::unique_ptr<RowStore>> nested; // cells of cells that held too much
};

// A subtree has up to `mostPoints`, or more where the octree can't part them: points at one position. Cells
// of `tiles` that hold more than a subtree are dealt into finer ones.
Result<SubtreePlan> planSubtrees(Tiles& tiles, std::uint64_t mostPoints, const std::atomic<bool>* stop);

} // namespace stipple
