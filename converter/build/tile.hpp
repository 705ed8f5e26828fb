// Phase 2: every point to a cell of the octree, in memory or, where that does not suffice, on disk.
//
// One pass over the inputs: points are dealt into cells of a cube around what the headers state. Where a
// header lied, that cube is not the one of the points; then what was dealt out is dealt again (or, if points
// lay so far out that rows could not hold them, read again). So what follows depends on the points alone.
#pragma once

#include "converter/build/convert.hpp"
#include "converter/build/point_sums.hpp"
#include "converter/build/row_layout.hpp"
#include "converter/build/row_store.hpp"
#include "converter/build/work_folder.hpp"
#include "shared/geometry/node_key.hpp"

namespace stipple {

// The smallest cube of 2^bits steps at the lowest corner of `bounds` that holds them. outOfRange if that
// takes more than maxRootBits.
Result<RootCube> rootCubeOf(const BoxI& bounds);

// A cell is the octree node of `level` in `cube`; cells are numbered by Morton code, x lowest.
struct CellGrid {
    static constexpr int deepest = 6; // level - under.level is at most this

    RootCube cube;
    int level = 0;
    NodeKey under{}; // the cells are those of this node's descendants

    std::size_t cells() const { return std::size_t{1} << (3 * (level - under.level)); }
    // Points outside the cube belong to the nearest cell.
    std::size_t cellOf(Vec3i p) const;
    NodeKey keyOf(std::size_t cell) const;
};

struct Tiles {
    RowLayout layout;
    CellGrid grid; // over the points' own cube
    PointSums sums;
    std::unique_ptr<ScratchFile> file;
    std::unique_ptr<RowPool> pool;
    std::unique_ptr<RowStore> cells;
    std::uint64_t rowsRead = 0; // points read, more than sums.points if inputs were read twice
    bool onDisk = false;        // a checkpoint of all points exists
};

struct TileOptions {
    int threads = 1;
    std::uint64_t memoryBytes = 0; // for points; see RowPool
    const std::atomic<bool>* stop = nullptr;
    std::atomic<std::uint64_t>* temporaryBytes = nullptr; // kept up to date
    std::uint64_t pointsPerRound = WorkSizes{}.pointsPerRound;
};

Result<Tiles> tile(const Scan& scan, const TileOptions& options, WorkFolder& folder,
                   const ConvertProgress& progress);

} // namespace stipple
