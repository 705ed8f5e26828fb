#include "converter/build/tile.hpp"

#include "converter/build/input_parts.hpp"
#include "converter/build/row_dealer.hpp"
#include "converter/parallel/parallel.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <array>
#include <mutex>

namespace stipple {

namespace {
constexpr const char* recordName = "tiles";
constexpr std::uint64_t pointsPerCell = std::uint64_t{1} << 17; // aimed at, on surfaces
constexpr int deepestCellLevel = CellGrid::deepest;

// Two zero bits between the bits of a cell's coordinate under its node.
constexpr auto spreadBits = [] {
    std::array<std::uint32_t, std::size_t{1} << deepestCellLevel> table{};
    for (std::uint32_t value = 0; value < table.size(); ++value)
        for (int bit = 0; bit < deepestCellLevel; ++bit)
            table[value] |= (value >> bit & 1u) << (3 * bit);
    return table;
}();

// The cloud's bounds as the inputs state them; empty if one of them does not.
BoxI statedBounds(const Scan& scan) {
    BoxI bounds;
    for (const ScannedInput& input : scan.inputs) {
        const InputDescription& description = input.description();
        if (description.source.pointCount == 0)
            continue;
        if (description.bounds.empty())
            return {};
        bounds.extend(input.toCloud.toCloud(description.bounds.min));
        bounds.extend(input.toCloud.toCloud(description.bounds.max));
    }
    return bounds;
}

int cellLevel(const RootCube& cube, std::uint64_t points) {
    int level = 0; // a surface meets 4^level cells
    while (level < std::min(deepestCellLevel, cube.bits) && points >> (2 * level) > pointsPerCell)
        ++level;
    return level;
}

// What one thread works with.
struct Worker {
    PartReader reader;
    RowDealer dealer;
};

class Tiling {
  public:
    Tiling(const Scan& scan, const TileOptions& options, WorkFolder& folder, const ConvertProgress& progress)
        : scan_(scan), options_(options), folder_(folder), progress_(progress), reads_(partsOf(scan)) {}

    Result<Tiles> run() {
        STIPPLE_TRY(resumed, resume());
        if (!resumed) {
            BoxI stated = statedBounds(scan_);
            if (stated.empty() || !rootCubeOf(stated).ok()) {
                STIPPLE_CHECK(measure());
                stated = tiles_.sums.bounds;
            }
            STIPPLE_CHECK(begin(stated));
        }
        STIPPLE_CHECK(readAll());
        if (misfit_) {
            // Points where the headers did not say: now their bounds are known.
            BoxI measured = tiles_.sums.bounds;
            STIPPLE_CHECK(begin(measured));
            STIPPLE_CHECK(readAll());
        }
        STIPPLE_CHECK(fitCube());
        if (mustSave() && !tiles_.onDisk)
            STIPPLE_CHECK(save(true));
        return std::move(tiles_);
    }

  private:
    // Starts over, for points in `bounds`.
    Status begin(const BoxI& bounds) {
        if (std::size_t most = scan_.schema.bytesPerPoint() + sizeof(Vec3i); most > RowPool::blockBytes)
            return Error{ErrorCode::limitExceeded,
                         cat("a point with its position and attributes takes ", most, " bytes, but at most ",
                             RowPool::blockBytes, " can be converted"),
                         "", "leave attributes out, or convert the inputs apart from each other"};
        STIPPLE_TRY(cube, rootCubeOf(bounds));
        tiles_.cells.reset();
        tiles_.pool.reset();
        tiles_.file.reset();
        // A checkpoint of what was there before would describe a file that holds other points.
        STIPPLE_CHECK(folder_.remove(recordName));
        recorded_ = false;
        STIPPLE_TRY(file, folder_.scratch("points", false));
        tiles_.file = std::move(file);
        tiles_.sums = PointSums(scan_.inputs.size());
        layOut(bounds, {cube, cellLevel(cube, scan_.pointCount)});
        nextRead_ = 0;
        done_ = 0;
        misfit_ = false;
        return {};
    }

    void layOut(const BoxI& bounds, const CellGrid& grid) {
        layoutBounds_ = bounds;
        tiles_.layout = RowLayout(scan_.schema, bounds);
        tiles_.grid = grid;
        tiles_.pool = std::make_unique<RowPool>(options_.memoryBytes, tiles_.file.get());
        tiles_.cells = std::make_unique<RowStore>(*tiles_.pool, tiles_.layout.rowBytes(), grid.cells());
    }

    // Reads everything for its bounds alone.
    Status measure() {
        measuring_ = true;
        tiles_.sums = PointSums(scan_.inputs.size());
        Status read = readAll();
        measuring_ = false;
        nextRead_ = 0;
        done_ = 0;
        return read;
    }

    Status readAll() {
        std::vector<Worker> workers(static_cast<std::size_t>(options_.threads));
        for (Worker& worker : workers)
            worker.dealer = RowDealer(measuring_ ? 0 : tiles_.grid.cells());
        while (nextRead_ < reads_.size()) {
            std::size_t first = nextRead_, end = first;
            for (std::uint64_t points = 0; end < reads_.size() && points < options_.pointsPerRound; ++end)
                points += reads_[end].points;
            for (Worker& worker : workers)
                worker.reader.sums = PointSums(scan_.inputs.size());
            STIPPLE_CHECK(
                parallelFor(end - first, options_.threads, options_.stop, [&](std::size_t i, int worker) {
                    return read(reads_[first + i], workers[static_cast<std::size_t>(worker)]);
                }));
            for (const Worker& worker : workers)
                tiles_.sums.add(worker.reader.sums);
            nextRead_ = end;
            if (!measuring_ && !misfit_ && mustSave() && end < reads_.size())
                STIPPLE_CHECK(save(false));
        }
        return {};
    }

    Status read(const PartRef& part, Worker& worker) {
        return readPart(scan_, part, worker.reader, [&](const PointBatch& batch) -> Status {
            if (!measuring_ && !misfit_) {
                addHashes(part.input, batch, worker.reader);
                STIPPLE_CHECK(deal(batch, worker));
            }
            report(batch.size());
            return {};
        });
    }

    // The cloud's hash, and that of the input, which is the same while its points are the cloud's unchanged.
    void addHashes(std::size_t input, const PointBatch& batch, PartReader& reader) const {
        PointHash ofBatch;
        ofBatch.add(scan_.schema, batch);
        reader.sums.hash.add(ofBatch);
        if (&batch != &reader.raw) {
            ofBatch = {};
            ofBatch.add(scan_.inputs[input].description().schema, reader.raw);
        }
        reader.sums.inputHashes[input].add(ofBatch);
    }

    void report(std::uint64_t points) {
        std::lock_guard lock(progressMutex_);
        done_ += points;
        tiles_.rowsRead += points;
        if (options_.temporaryBytes && tiles_.pool)
            *options_.temporaryBytes = tiles_.pool->spilledBytes();
        progress_(measuring_ ? "measure" : "tile", done_, scan_.pointCount);
    }

    Status deal(const PointBatch& batch, Worker& worker) {
        return worker.dealer.deal(tiles_.layout, batch, *tiles_.cells, [this](Vec3i p) {
            if (tiles_.layout.holds(p))
                return tiles_.grid.cellOf(p);
            misfit_ = true;
            return RowDealer::nowhere;
        });
    }

    // Deals again if the points' own cube is not the one that the headers stated.
    Status fitCube() {
        STIPPLE_TRY(cube, rootCubeOf(tiles_.sums.bounds));
        if (cube == tiles_.grid.cube)
            return {};
        CellGrid grid{cube, cellLevel(cube, tiles_.sums.points)};
        auto cells = std::make_unique<RowStore>(*tiles_.pool, tiles_.layout.rowBytes(), grid.cells());
        std::size_t rowBytes = tiles_.layout.rowBytes();
        auto deal = [&](const std::uint8_t* rows, std::size_t count) -> Status {
            for (std::size_t i = 0, end = 0; i < count; i = end) {
                std::size_t to = grid.cellOf(tiles_.layout.position(rows + i * rowBytes));
                for (end = i + 1; end < count; ++end)
                    if (grid.cellOf(tiles_.layout.position(rows + end * rowBytes)) != to)
                        break;
                STIPPLE_CHECK(cells->append(to, rows + i * rowBytes, end - i));
            }
            return {};
        };
        STIPPLE_CHECK(
            parallelFor(tiles_.cells->cells(), options_.threads, options_.stop,
                        [&](std::size_t cell, int) { return tiles_.cells->drain(cell, false, deal); }));
        // What the old cells have on disk is what a crash would go on from until the new ones are saved.
        std::swap(tiles_.cells, cells);
        tiles_.grid = grid;
        tiles_.onDisk = false;
        if (mustSave())
            STIPPLE_CHECK(save(true));
        for (std::size_t cell = 0; cell < cells->cells(); ++cell)
            cells->forget(cell);
        return {};
    }

    // Points that went to disk are worth a checkpoint; and an earlier one must not outlive the cells that it
    // describes, even if all that came since fits memory.
    bool mustSave() const { return recorded_ || tiles_.pool->spilledBytes() > 0; }

    Status save(bool complete) {
        STIPPLE_CHECK(tiles_.cells->saveAll());
        ByteWriter record;
        record.write<std::uint8_t>(complete);
        record.write<std::uint64_t>(nextRead_);
        record.write(layoutBounds_.min);
        record.write(layoutBounds_.max);
        record.write(tiles_.grid.cube.min);
        record.write(tiles_.grid.cube.bits);
        record.write(tiles_.grid.level);
        record.write(tiles_.file->end());
        tiles_.sums.save(record);
        tiles_.cells->describe(record);
        STIPPLE_CHECK(folder_.save(recordName, record.bytes()));
        tiles_.onDisk = complete;
        recorded_ = true;
        return {};
    }

    // Takes up an earlier run's points. False if there are none, or they are damaged.
    Result<bool> resume() {
        auto record = folder_.load(recordName);
        if (!record.ok())
            return false;
        ByteReader from(*record);
        bool complete = from.read<std::uint8_t>() != 0;
        std::uint64_t reads = from.read<std::uint64_t>();
        BoxI bounds;
        bounds.min = from.read<Vec3i>();
        bounds.max = from.read<Vec3i>();
        CellGrid grid;
        grid.cube.min = from.read<Vec3i>();
        grid.cube.bits = from.read<int>();
        grid.level = from.read<int>();
        std::uint64_t end = from.read<std::uint64_t>();
        tiles_.sums = PointSums(scan_.inputs.size());
        if (!tiles_.sums.load(from) || grid.level < 0 || grid.level > deepestCellLevel ||
            reads > reads_.size())
            return false;
        STIPPLE_TRY(file, folder_.scratch("points", true));
        tiles_.file = std::move(file);
        tiles_.file->setEnd(end);
        layOut(bounds, grid);
        if (!tiles_.cells->restore(from))
            return false;
        nextRead_ = static_cast<std::size_t>(reads);
        done_ = tiles_.sums.points;
        tiles_.onDisk = complete;
        recorded_ = true;
        return true;
    }

    const Scan& scan_;
    const TileOptions& options_;
    WorkFolder& folder_;
    const ConvertProgress& progress_;
    const std::vector<PartRef> reads_;
    Tiles tiles_;
    BoxI layoutBounds_;
    std::size_t nextRead_ = 0; // of reads_; all before it are in the cells
    bool recorded_ = false;    // the folder has a checkpoint of these cells
    bool measuring_ = false;
    std::atomic<bool> misfit_{false}; // a point lay where rows can't hold it
    std::mutex progressMutex_;
    std::uint64_t done_ = 0;
};
} // namespace

std::size_t CellGrid::cellOf(Vec3i p) const {
    std::size_t cell = 0;
    const int bits = level - under.level, shift = cube.nodeBits(level);
    const Vec3i corner = cube.nodeMin(under);
    const std::int64_t last = (std::int64_t{1} << bits) - 1;
    for (int axis = 0; axis < 3; ++axis) {
        std::int64_t at = std::clamp<std::int64_t>((p[axis] - corner[axis]) >> shift, 0, last);
        cell |= std::size_t{spreadBits[static_cast<std::size_t>(at)]} << axis;
    }
    return cell;
}

NodeKey CellGrid::keyOf(std::size_t cell) const {
    NodeKey key = under;
    for (int depth = level - under.level; depth-- > 0;)
        key = key.child(static_cast<int>(cell >> (3 * depth) & 7));
    return key;
}

Result<RootCube> rootCubeOf(const BoxI& bounds) {
    RootCube cube;
    if (bounds.empty())
        return cube;
    cube.min = bounds.min;
    for (int axis = 0; axis < 3; ++axis) {
        // Unsigned, as the difference of two 64-bit integers may not fit a signed one.
        std::uint64_t extent =
            static_cast<std::uint64_t>(bounds.max[axis]) - static_cast<std::uint64_t>(bounds.min[axis]);
        if (extent >> maxRootBits)
            return Error{ErrorCode::outOfRange,
                         cat("the points span more than 2^", maxRootBits, " grid steps in ", "xyz"[axis]), "",
                         "remove stray points, or convert the inputs apart from each other"};
        while (extent >> cube.bits)
            ++cube.bits;
    }
    return cube;
}

Result<Tiles> tile(const Scan& scan, const TileOptions& options, WorkFolder& folder,
                   const ConvertProgress& progress) {
    return Tiling(scan, options, folder, progress).run();
}

} // namespace stipple
