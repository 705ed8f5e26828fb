#include "converter/build/subtree_plan.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <bit>

namespace stipple {

namespace {
// Points of every node over the cells: [depth][Morton number].
std::vector<std::vector<std::uint64_t>> pyramid(const RowStore& store, int depth) {
    std::vector<std::vector<std::uint64_t>> counts(static_cast<std::size_t>(depth) + 1);
    counts.back().resize(store.cells());
    for (std::size_t cell = 0; cell < store.cells(); ++cell)
        counts.back()[cell] = store.count(cell);
    for (std::size_t d = counts.size() - 1; d-- > 0;) {
        counts[d].resize(counts[d + 1].size() / 8);
        for (std::size_t i = 0; i < counts[d + 1].size(); ++i)
            counts[d][i / 8] += counts[d + 1][i];
    }
    return counts;
}

class Planner {
  public:
    Planner(Tiles& tiles, std::uint64_t mostPoints, const std::atomic<bool>* stop)
        : tiles_(tiles), mostPoints_(mostPoints), stop_(stop) {}

    Result<SubtreePlan> run() {
        STIPPLE_CHECK(plan(*tiles_.cells, tiles_.grid));
        return std::move(plan_);
    }

  private:
    Status plan(RowStore& store, const CellGrid& grid) {
        auto counts = pyramid(store, grid.level - grid.under.level);
        return visit(store, grid, counts, 0, 0);
    }

    Status visit(RowStore& store, const CellGrid& grid, const std::vector<std::vector<std::uint64_t>>& counts,
                 std::size_t depth, std::size_t node) {
        std::uint64_t points = counts[depth][node];
        if (points == 0)
            return {};
        std::size_t below = counts.size() - 1 - depth;
        if (points <= mostPoints_) {
            add(store, grid, node << (3 * below), std::size_t{1} << (3 * below),
                static_cast<int>(grid.level - static_cast<int>(below)), points);
            return {};
        }
        if (below == 0)
            return divide(store, grid, node);
        for (std::size_t child = 0; child < 8; ++child)
            STIPPLE_CHECK(visit(store, grid, counts, depth + 1, 8 * node + child));
        return {};
    }

    void add(RowStore& store, const CellGrid& grid, std::size_t firstCell, std::size_t cells, int level,
             std::uint64_t points) {
        PlannedSubtree subtree;
        subtree.key = grid.keyOf(firstCell);
        while (subtree.key.level > level)
            subtree.key = subtree.key.parent();
        subtree.points = points;
        for (std::size_t cell = firstCell; cell < firstCell + cells; ++cell)
            if (store.count(cell) > 0)
                subtree.cells.push_back({&store, cell});
        plan_.subtrees.push_back(std::move(subtree));
    }

    // A cell of too many points: into cells below the smallest node that holds them all.
    Status divide(RowStore& store, const CellGrid& grid, std::size_t cell) {
        if (stop_ && *stop_)
            return Error{ErrorCode::cancelled, "interrupted", "", ""};
        const std::size_t rowBytes = tiles_.layout.rowBytes();
        BoxI bounds;
        STIPPLE_CHECK(store.drain(cell, true, [&](const std::uint8_t* rows, std::size_t count) -> Status {
            for (std::size_t i = 0; i < count; ++i)
                bounds.extend(tiles_.layout.position(rows + i * rowBytes));
            return {};
        }));
        const RootCube& cube = grid.cube;
        const int deepest = std::min(cube.bits, maxLevel);
        Vec3i low = bounds.min - cube.min, high = bounds.max - cube.min;
        auto difference = static_cast<std::uint64_t>((low.x ^ high.x) | (low.y ^ high.y) | (low.z ^ high.z));
        int level =
            cube.bits - static_cast<int>(std::bit_width(difference)); // of the smallest node that holds them
        std::uint64_t points = store.count(cell);
        if (difference == 0 || level >= deepest)
            return addWhole(store, grid, cell, points);
        CellGrid finer{cube, level + 1, cube.keyOf(bounds.min, level)};
        while (finer.level < deepest && finer.level - level < CellGrid::deepest &&
               points >> (2 * (finer.level - level)) > mostPoints_ / 4)
            ++finer.level;
        auto nested = std::make_unique<RowStore>(*tiles_.pool, rowBytes, finer.cells());
        auto deal = [&](const std::uint8_t* rows, std::size_t count) -> Status {
            for (std::size_t i = 0; i < count; ++i)
                STIPPLE_CHECK(nested->append(finer.cellOf(tiles_.layout.position(rows + i * rowBytes)),
                                             rows + i * rowBytes, 1));
            return {};
        };
        STIPPLE_CHECK(store.drain(cell, false, deal));
        RowStore& inner = *nested;
        plan_.nested.push_back(std::move(nested));
        return plan(inner, finer);
    }

    // A cell that can't be parted. In a store of its own, as it will be forgotten bit by bit: a run that is
    // killed meanwhile plans again with the cells of the tiles, which therefore stay as they are until then.
    Status addWhole(RowStore& store, const CellGrid& grid, std::size_t cell, std::uint64_t points) {
        auto whole = std::make_unique<RowStore>(*tiles_.pool, tiles_.layout.rowBytes(), 1);
        STIPPLE_CHECK(store.drain(cell, false, [&](const std::uint8_t* rows, std::size_t count) {
            return whole->append(0, rows, count);
        }));
        add(*whole, {grid.cube, grid.level, grid.keyOf(cell)}, 0, 1, grid.level, points);
        plan_.nested.push_back(std::move(whole));
        return {};
    }

    Tiles& tiles_;
    std::uint64_t mostPoints_;
    const std::atomic<bool>* stop_;
    SubtreePlan plan_;
};
} // namespace

Result<SubtreePlan> planSubtrees(Tiles& tiles, std::uint64_t mostPoints, const std::atomic<bool>* stop) {
    return Planner(tiles, mostPoints, stop).run();
}

} // namespace stipple
