#include "converter/build/compare_inputs.hpp"

#include "converter/build/input_parts.hpp"
#include "converter/build/memory_share.hpp"
#include "converter/build/row_dealer.hpp"
#include "converter/build/tile.hpp"
#include "converter/parallel/parallel.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <bit>
#include <mutex>
#include <numeric>

namespace stipple {

namespace {
constexpr std::uint64_t pointsPerCell = std::uint64_t{1} << 17; // aimed at, of both sides, on surfaces
constexpr std::uint64_t tableBytesPerPoint = 64;                // at most, on both sides (counted_rows.hpp)

BoxI boxOf(const RootCube& cube) {
    const std::int64_t last = (std::int64_t{1} << cube.bits) - 1;
    return {cube.min, cube.min + Vec3i{last, last, last}};
}

// Points of one position have one hash.
std::size_t positionHash(Vec3i p) {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
        hash = (hash ^ static_cast<std::uint64_t>(p[axis])) * 0x9E3779B185EBCA87ull;
        hash ^= hash >> 32;
    }
    return static_cast<std::size_t>(hash * 0xC2B2AE3D27D4EB4Full >> 32);
}

// Both sides' points that wait, by cell.
struct Sides {
    RowStore file, inputs;

    Sides(RowPool& pool, std::size_t rowBytes, std::size_t cells)
        : file(pool, rowBytes, cells), inputs(pool, rowBytes, cells) {}
    std::uint64_t count(std::size_t cell) const { return file.count(cell) + inputs.count(cell); }
    void forget(std::size_t cell) {
        file.forget(cell);
        inputs.forget(cell);
    }
};

// What one thread works with.
struct Worker {
    Worker(const RowLayout& layout, const Grid& grid, std::size_t cells)
        : dealer(cells), comparer(layout, grid) {}

    PartReader reader;
    RowDealer dealer;
    PointComparer comparer;
    Comparison found;
    std::vector<std::uint8_t> unmatchedHoldValues;
    std::vector<std::uint32_t> indices;
    Bytes rows;
};

class CellComparison {
  public:
    CellComparison(const Scan& scan, std::span<const UnmatchedAttribute> unmatched, const FileNodes& file,
                   const CompareOptions& options, const ConvertProgress& progress)
        : scan_(scan), unmatched_(unmatched), file_(file), options_(options), progress_(progress),
          layout_(scan.schema, boxOf(file.metadata.rootCube)),
          mostPoints_(std::max<std::uint64_t>(1, options.memoryBytes / 2 /
                                                     static_cast<std::uint64_t>(options.threads) /
                                                     (2 * layout_.rowBytes() + tableBytesPerPoint))),
          grid_{file.metadata.rootCube, cellLevel()} {}

    Result<InputComparison> run() {
        sortNodes();
        STIPPLE_CHECK(checkDisk());
        // Without the file all goes well as long as memory suffices.
        auto scratch = ScratchFile::createNameless(options_.temp);
        RowPool pool(options_.memoryBytes / 2, scratch.ok() ? scratch->get() : nullptr);
        Status done = runWith(pool);
        if (!done && done.error().code == ErrorCode::limitExceeded && !scratch.ok())
            return scratch.error();
        if (!done)
            return done.error();
        for (Worker& worker : workers_) {
            result_.comparison.add(worker.found);
            result_.sums.add(worker.reader.sums);
            for (std::size_t u = 0; u < unmatched_.size(); ++u)
                result_.unmatchedHoldValues[u] |= worker.unmatchedHoldValues[u];
        }
        return std::move(result_);
    }

  private:
    Status runWith(RowPool& pool) {
        pool_ = &pool;
        Sides cells(pool, layout_.rowBytes(), grid_.cells());
        for (int t = 0; t < options_.threads; ++t) {
            Worker& worker = workers_.emplace_back(layout_, scan_.grid, grid_.cells());
            worker.reader.sums = PointSums(scan_.inputs.size());
            worker.unmatchedHoldValues.resize(unmatched_.size());
        }
        result_.unmatchedHoldValues.resize(unmatched_.size());
        result_.sums = PointSums(scan_.inputs.size());
        result_.comparison.changedPerAttribute.resize(scan_.schema.attributes.size());
        STIPPLE_CHECK(dealInputs(cells));
        STIPPLE_CHECK(dealNodes(upperNodes_, cells.file, [this](Vec3i p) { return grid_.cellOf(p); }));
        std::vector<std::size_t> some, tooLarge;
        for (std::size_t cell = 0; cell < grid_.cells(); ++cell)
            if (std::uint64_t points = cells.count(cell) + pointsBelow_[cell]; points > 0)
                (points > mostPoints_ ? tooLarge : some).push_back(cell);
        STIPPLE_CHECK(forEach(some.size(), [&](std::size_t i, Worker& worker, int number) {
            return compareCell(cells, some[i], nodesBelow(some[i]), worker, number);
        }));
        for (std::size_t cell : tooLarge)
            STIPPLE_CHECK(compareLarge(cells, cell));
        return {};
    }

    int cellLevel() const {
        const std::uint64_t points = scan_.pointCount + file_.metadata.pointCount;
        const std::uint64_t aim = std::min(pointsPerCell, mostPoints_ / 4);
        int level = 0; // a surface meets 4^level cells
        while (level < std::min(CellGrid::deepest, file_.metadata.rootCube.bits) &&
               points >> (2 * level) > aim)
            ++level;
        return level;
    }

    // Which nodes are above the cells, and which below each.
    void sortNodes() {
        std::vector<std::pair<std::size_t, std::uint32_t>> below;
        pointsBelow_.assign(grid_.cells(), 0);
        firstBelow_.assign(grid_.cells() + 1, 0);
        for (std::uint32_t i = 0; i < file_.entries.size(); ++i) {
            const NodeEntry& entry = file_.entries[i];
            if (entry.pointCount == 0)
                continue;
            // Reading one that is smaller than a step says what is wrong with it.
            if (entry.key.level < grid_.level || entry.key.level > grid_.cube.bits) {
                upperNodes_.push_back(i);
                pointsAbove_ += entry.pointCount;
                continue;
            }
            std::size_t cell = grid_.cellOf(grid_.cube.nodeMin(entry.key));
            below.emplace_back(cell, i);
            pointsBelow_[cell] += entry.pointCount;
            ++firstBelow_[cell + 1];
        }
        std::sort(below.begin(), below.end());
        for (const auto& [cell, node] : below)
            lowerNodes_.push_back(node);
        std::partial_sum(firstBelow_.begin(), firstBelow_.end(), firstBelow_.begin());
    }

    std::span<const std::uint32_t> nodesBelow(std::size_t cell) const {
        return std::span(lowerNodes_).subspan(firstBelow_[cell], firstBelow_[cell + 1] - firstBelow_[cell]);
    }

    // What is known to be put aside. Cells that are too large come on top.
    Status checkDisk() const {
        return refuseFullDisk((scan_.pointCount + pointsAbove_) * layout_.rowBytes(),
                              options_.memoryBytes / 2, options_.temp);
    }

    template <class Task>
    Status forEach(std::size_t count, Task task) {
        return parallelFor(count, options_.threads, options_.stop, [&](std::size_t i, int number) {
            return task(i, workers_[static_cast<std::size_t>(number)], number);
        });
    }

    Status dealInputs(Sides& cells) {
        const std::vector<PartRef> parts = partsOf(scan_);
        std::uint64_t read = 0;
        return forEach(parts.size(), [&](std::size_t i, Worker& worker, int) {
            return readPart(scan_, parts[i], worker.reader, [&](const PointBatch& batch) -> Status {
                auto cellOf = [&](Vec3i p) {
                    if (layout_.holds(p))
                        return grid_.cellOf(p);
                    worker.found.addMissing(scan_.grid, p); // the root cube does not reach that far
                    return RowDealer::nowhere;
                };
                lookForValues(parts[i].input, worker);
                STIPPLE_CHECK(worker.dealer.deal(layout_, batch, cells.inputs, cellOf));
                report("tile", read, batch.size(), scan_.pointCount);
                return {};
            });
        });
    }

    // In attributes that the file lacks.
    void lookForValues(std::size_t input, Worker& worker) const {
        for (std::size_t u = 0; u < unmatched_.size(); ++u) {
            const int source = unmatched_[u].sources[input];
            if (!unmatched_[u].imposed || source < 0 || worker.unmatchedHoldValues[u] != 0)
                continue;
            const Bytes& column = worker.reader.raw.columns[static_cast<std::size_t>(source)];
            worker.unmatchedHoldValues[u] =
                std::any_of(column.begin(), column.end(), [](std::uint8_t byte) { return byte != 0; });
        }
    }

    template <class CellOf>
    Status dealNodes(std::span<const std::uint32_t> nodes, RowStore& to, CellOf cellOf) {
        return forEach(nodes.size(), [&](std::size_t i, Worker& worker, int number) -> Status {
            STIPPLE_TRY(batch, readNode(nodes[i], number));
            return batch ? worker.dealer.deal(layout_, *batch, to, cellOf) : Status{};
        });
    }

    Result<const PointBatch*> readNode(std::uint32_t node, int number) {
        STIPPLE_TRY(batch, file_.read(file_.entries[node], number));
        report("verify", nodePoints_, file_.entries[node].pointCount, file_.metadata.pointCount);
        return batch;
    }

    // What waits of the file in the cell and what is in the nodes, against what waits of the inputs.
    Status compareCell(Sides& sides, std::size_t cell, std::span<const std::uint32_t> nodes, Worker& worker,
                       int number) {
        std::uint64_t points = sides.file.count(cell);
        for (std::uint32_t node : nodes)
            points += file_.entries[node].pointCount;
        PointComparer& comparer = worker.comparer;
        comparer.begin(static_cast<std::size_t>(std::min(points, mostPoints_)));
        STIPPLE_CHECK(
            sides.file.drain(cell, false, [&](const std::uint8_t* rows, std::size_t count) -> Status {
                comparer.addFile(rows, count);
                return {};
            }));
        for (std::uint32_t node : nodes) {
            STIPPLE_TRY(batch, readNode(node, number));
            if (batch)
                addFile(*batch, worker);
        }
        STIPPLE_CHECK(
            sides.inputs.drain(cell, false, [&](const std::uint8_t* rows, std::size_t count) -> Status {
                comparer.addInput(rows, count);
                return {};
            }));
        sides.forget(cell);
        worker.found.add(comparer.finish());
        return {};
    }

    void addFile(const PointBatch& batch, Worker& worker) {
        const std::size_t most = std::min(batch.size(), pointsPerBatch);
        worker.rows.resize(most * layout_.rowBytes());
        for (std::size_t first = 0; first < batch.size(); first += most) {
            const std::size_t count = std::min(most, batch.size() - first);
            worker.indices.resize(count);
            std::iota(worker.indices.begin(), worker.indices.end(), static_cast<std::uint32_t>(first));
            layout_.pack(batch, worker.indices, worker.rows.data());
            worker.comparer.addFile(worker.rows.data(), count);
        }
    }

    // A cell of more points than memory is for: parted by a hash of positions, which parts any but those of
    // one position.
    Status compareLarge(Sides& cells, std::size_t cell) {
        const std::uint64_t points = cells.count(cell) + pointsBelow_[cell];
        constexpr std::uint64_t mostParts = std::uint64_t{1} << 16;
        const std::size_t parts =
            static_cast<std::size_t>(std::min(mostParts, std::bit_ceil(2 * points / mostPoints_)));
        auto partOf = [parts](Vec3i p) { return positionHash(p) & (parts - 1); };
        Sides sides(*pool_, layout_.rowBytes(), parts);
        for (Worker& worker : workers_)
            worker.dealer = RowDealer(parts);
        auto dealTo = [&](RowStore& to) {
            return [&](const std::uint8_t* rows, std::size_t count) {
                return workers_[0].dealer.deal(layout_, rows, count, to, partOf);
            };
        };
        STIPPLE_CHECK(cells.inputs.drain(cell, false, dealTo(sides.inputs)));
        STIPPLE_CHECK(cells.file.drain(cell, false, dealTo(sides.file)));
        cells.forget(cell);
        STIPPLE_CHECK(dealNodes(nodesBelow(cell), sides.file, partOf));
        return forEach(parts, [&](std::size_t part, Worker& worker, int number) {
            return compareCell(sides, part, {}, worker, number);
        });
    }

    void report(const char* phase, std::uint64_t& done, std::uint64_t points, std::uint64_t total) {
        std::lock_guard lock(mutex_);
        done += points;
        if (options_.temporaryBytes)
            *options_.temporaryBytes = pool_->spilledBytes();
        progress_(phase, done, total);
    }

    const Scan& scan_;
    const std::span<const UnmatchedAttribute> unmatched_;
    const FileNodes& file_;
    const CompareOptions& options_;
    const ConvertProgress& progress_;
    const RowLayout layout_;
    const std::uint64_t mostPoints_; // compared at once by one thread, of both sides together
    const CellGrid grid_;
    std::vector<std::uint32_t> upperNodes_, lowerNodes_; // indices of entries; the lower ones cell by cell
    std::vector<std::uint32_t> firstBelow_;              // of each cell in lowerNodes_, then the end
    std::vector<std::uint64_t> pointsBelow_;             // in each cell's lower nodes
    std::uint64_t pointsAbove_ = 0;
    RowPool* pool_ = nullptr;
    std::deque<Worker> workers_;
    InputComparison result_;
    std::mutex mutex_;
    std::uint64_t nodePoints_ = 0;
};
} // namespace

Result<InputComparison> compareWithInputs(const Scan& scan, std::span<const UnmatchedAttribute> unmatched,
                                          const FileNodes& file, const CompareOptions& options,
                                          const ConvertProgress& progress) {
    return CellComparison(scan, unmatched, file, options, progress).run();
}

} // namespace stipple
