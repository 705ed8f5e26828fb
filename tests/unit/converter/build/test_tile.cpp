#include "converter/build/tile.hpp"
#include "tests/unit/converter/build/test_scan.hpp"
#include "tests/unit/converter/build/tiled_rows.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {
// The bounds that a LAS header states, in world units (LAS 1.4 §2.4: max and min of each axis in turn).
void stateBounds(const std::string& path, Vec3d min, Vec3d max) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    for (int axis = 0; axis < 3; ++axis) {
        double ends[2] = {max[axis], min[axis]};
        file.seekp(179 + 16 * axis);
        file.write(reinterpret_cast<const char*>(ends), sizeof ends);
    }
    REQUIRE(file.good());
}

Scan scanOrFail(const std::vector<std::string>& paths) {
    auto scan = scanInputs(paths, {});
    if (!scan)
        FAIL(scan.error().sentence());
    return std::move(scan).value();
}

std::unique_ptr<WorkFolder> workFolder(const std::string& path) {
    std::vector<std::string> warnings;
    auto folder = WorkFolder::open(path, "test", warnings);
    if (!folder)
        FAIL(folder.error().sentence());
    return std::move(folder).value();
}

Tiles tileOrFail(const Scan& scan, const TileOptions& options, WorkFolder& folder) {
    auto tiles = tile(scan, options, folder, noProgress);
    if (!tiles)
        FAIL(tiles.error().sentence());
    return std::move(tiles).value();
}

// Some files of 20,000 points each, a part each, that overlap.
std::vector<std::string> writeFiles(TemporaryFolder& folder, std::size_t count) {
    std::vector<std::string> paths;
    for (std::size_t i = 0; i < count; ++i) {
        TestScan scan = surfaceScan(1, 20000, i);
        for (Vec3i& p : scan.points.positions)
            p.x += 5000 * static_cast<std::int64_t>(i);
        paths.push_back(folder / ("scan" + std::to_string(i) + ".las"));
        writeScan(scan, paths.back());
    }
    return paths;
}

constexpr std::uint64_t oneFile = 20000; // points: a round each

// The checkpoint after `rounds` files: stopped then, and the folder kept.
void stopAfter(std::uint64_t rounds, const Scan& scan, TileOptions options, WorkFolder& folder) {
    std::atomic<bool> stop{false};
    options.stop = &stop;
    auto tiles = tile(scan, options, folder, [&](const std::string&, std::uint64_t done, std::uint64_t) {
        if (done >= rounds * oneFile)
            stop = true;
    });
    REQUIRE_FALSE(tiles.ok());
    CHECK(tiles.error().code == ErrorCode::cancelled);
    folder.keep();
}
} // namespace

TEST_CASE("cells are numbered as the nodes of their level", "[tile]") {
    std::mt19937_64 random(4);
    for (int bits : {0, 3, 17, 40, 52})
        for (int levels = 0; levels <= std::min(bits, 4); ++levels) {
            CellGrid grid;
            grid.cube = {{-1000, 77, std::int64_t{1} << 50}, bits};
            int above = std::min(bits - levels, 9);
            grid.under.level = static_cast<std::uint8_t>(above);
            for (std::uint32_t* at : {&grid.under.x, &grid.under.y, &grid.under.z})
                *at = static_cast<std::uint32_t>(random() % (std::uint64_t{1} << above));
            grid.level = above + levels;
            std::int64_t side = std::int64_t{1} << grid.cube.nodeBits(grid.level);
            std::size_t wrong = 0;
            for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
                NodeKey key = grid.keyOf(cell);
                Vec3i low = grid.cube.nodeMin(key),
                      high{low.x + side - 1, low.y + side - 1, low.z + side - 1};
                wrong += key.level == grid.level && grid.cellOf(low) == cell && grid.cellOf(high) == cell &&
                                 grid.cube.keyOf(high, grid.level) == key
                             ? 0
                             : 1;
            }
            CHECK(wrong == 0);
        }
}

TEST_CASE("points outside the cube belong to the nearest cell", "[tile]") {
    CellGrid grid{{{0, 0, 0}, 10}, 3, {}}; // cells of 128 steps
    CHECK(grid.keyOf(grid.cellOf({-5, 300, 99999})) == NodeKey{3, 0, 2, 7});
    CHECK(grid.keyOf(grid.cellOf({1024, -1, -(std::int64_t{1} << 40)})) == NodeKey{3, 7, 0, 0});
    CellGrid upper{{{0, 0, 0}, 10}, 3, {1, 1, 1, 1}};
    CHECK(upper.keyOf(upper.cellOf({0, 0, 0})) == NodeKey{3, 4, 4, 4});
}

TEST_CASE("whatever the header states, the cells are those of the points", "[tile]") {
    TemporaryFolder folder;
    TestScan scan = surfaceScan(1, 300000, 3); // two parts
    auto tiled = [&](const std::string& name, std::uint64_t memoryBytes, int threads) {
        Scan scanned = scanOrFail({folder / name});
        auto work = workFolder(folder / (name + ".work"));
        return tileOrFail(scanned, {threads, memoryBytes}, *work);
    };
    writeScan(scan, folder / "true.las");
    Tiles honest = tiled("true.las", 1 << 30, 1);
    std::vector<std::string> expected = pointsOf(honest);
    CHECK(expected.size() == scan.points.size());
    CHECK(honest.rowsRead == scan.points.size());
    CHECK(honest.grid.level > 0);

    struct Lie {
        const char* name;
        Vec3d min, max; // relative to the offset of the grid
        int timesRead;
    };
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const Lie lies[] = {
        {"larger", {0, 0, 0}, {2400, 1600, 80}, 1},
        {"far larger", {-2e7, -2e7, -2e7}, {2e7, 2e7, 2e7}, 1},
        {"smaller", {100, 100, 1}, {160, 140, 2}, 1},
        {"a point", {300, 200, 2}, {300, 200, 2}, 1},
        {"beside", {600, 400, 10}, {1200, 800, 20}, 1},
        {"far out, where rows of its points can't hold these", {3.5e7, 3.5e7, 3.5e7}, {4e7, 4e7, 4e7}, 2},
        {"upside down", {600, 400, 5}, {0, 0, 0}, 2},
        {"no number", {nan, nan, nan}, {nan, nan, nan}, 2},
        {"no 32-bit numbers", {-1e300, 0, 0}, {1e300, 400, 5}, 2},
    };
    for (const Lie& lie : lies) {
        INFO("stated bounds: " << lie.name);
        writeScan(scan, folder / "lie.las");
        stateBounds(folder / "lie.las", scan.grid.offset + lie.min, scan.grid.offset + lie.max);
        bool fits = (&lie - lies) % 2 != 0;
        Tiles tiles = tiled("lie.las", std::uint64_t{1} << (fits ? 30 : 20), 2);
        CHECK((tiles.pool->spilledBytes() == 0) == fits);
        CHECK(tiles.grid.cube == honest.grid.cube);
        CHECK(tiles.grid.level == honest.grid.level);
        CHECK(tiles.sums.hash == honest.sums.hash);
        CHECK(tiles.sums.points == honest.sums.points);
        CHECK(tiles.sums.bounds == honest.sums.bounds);
        CHECK((tiles.rowsRead > scan.points.size()) == (lie.timesRead > 1));
        CHECK((pointsOf(tiles) == expected));
    }
}

TEST_CASE("points that do not fit memory go to disk, whoever deals them", "[tile]") {
    TemporaryFolder folder;
    auto paths = writeFiles(folder, 8);
    Scan scan = scanOrFail(paths);
    auto work = workFolder(folder / "a.work");
    Tiles inMemory = tileOrFail(scan, {1, std::uint64_t{1} << 30}, *work);
    CHECK(inMemory.pool->spilledBytes() == 0);
    CHECK_FALSE(inMemory.onDisk);
    auto expected = pointsOf(inMemory);
    for (int threads = 1; threads <= 4; ++threads) {
        auto other = workFolder(folder / "b.work");
        Tiles tiles = tileOrFail(scan, {.threads = threads, .memoryBytes = 1, .pointsPerRound = 1}, *other);
        CHECK(tiles.pool->spilledBytes() > 0);
        CHECK(tiles.onDisk);
        CHECK(tiles.sums.hash == inMemory.sums.hash);
        CHECK((pointsOf(tiles) == expected));
    }
}

TEST_CASE("tiling goes on from its checkpoint, whichever it is", "[tile]") {
    TemporaryFolder folder;
    auto paths = writeFiles(folder, 8);
    Scan scan = scanOrFail(paths);
    auto whole = workFolder(folder / "whole.work");
    TileOptions options{.threads = 2, .memoryBytes = 1, .pointsPerRound = oneFile};
    Tiles expected = tileOrFail(scan, options, *whole);
    auto expectedPoints = pointsOf(expected);
    for (std::uint64_t rounds : {3u, 5u, 7u}) {
        INFO("stopped after " << rounds << " of 8 rounds");
        {
            auto work = workFolder(folder / "work");
            stopAfter(rounds, scan, options, *work);
        }
        TileOptions onward = options;
        onward.memoryBytes = rounds == 7 ? std::uint64_t{1} << 30 : 1; // more memory than before is fine
        {
            auto work = workFolder(folder / "work");
            REQUIRE(work->resumes());
            Tiles tiles = tileOrFail(scan, onward, *work);
            CHECK(tiles.rowsRead == (8 - rounds) * oneFile);
            CHECK(tiles.onDisk);
            CHECK(tiles.sums.hash == expected.sums.hash);
            CHECK(tiles.sums.points == expected.sums.points);
            CHECK(tiles.sums.inputBounds == expected.sums.inputBounds);
            CHECK((pointsOf(tiles) == expectedPoints));
            work->keep();
        }
        // Killed after the last point: nothing is read again.
        auto work = workFolder(folder / "work");
        Tiles tiles = tileOrFail(scan, onward, *work);
        CHECK(tiles.rowsRead == 0);
        CHECK((pointsOf(tiles) == expectedPoints));
    }
}

TEST_CASE("a checkpoint under a header that lies is gone on from, too", "[tile]") {
    TemporaryFolder folder;
    auto paths = writeFiles(folder, 8);
    Scan honest = scanOrFail(paths);
    auto whole = workFolder(folder / "whole.work");
    Tiles expected = tileOrFail(honest, {.threads = 1}, *whole);
    auto expectedPoints = pointsOf(expected);
    // Too large; and where rows can't hold the last file's points, so that all is read again.
    struct Lie {
        double low, high;
        bool readAgain;
    };
    for (const Lie& lie : {Lie{0, 1e6, false}, Lie{3.5e7, 4e7, true}}) {
        stateBounds(paths[7], Vec3d{500000, 4000000, 0} + Vec3d{lie.low, lie.low, lie.low},
                    Vec3d{500000, 4000000, 0} + Vec3d{lie.high, lie.high, lie.high});
        if (lie.readAgain) // all headers lie the same way, but for the first 7 rounds' points
            for (std::size_t i = 0; i < 7; ++i) {
                TestScan moved = surfaceScan(1, 20000, i);
                moved.grid.offset = {500000, 4000000, 0};
                writeScan(moved, paths[i]);
            }
        Scan scan = scanOrFail(paths);
        TileOptions options{.threads = 2, .memoryBytes = 1, .pointsPerRound = oneFile};
        {
            auto work = workFolder(folder / "work");
            stopAfter(5, scan, options, *work);
        }
        auto work = workFolder(folder / "work");
        Tiles tiles =
            tileOrFail(scan, {.threads = 2, .memoryBytes = 1 << 30, .pointsPerRound = oneFile}, *work);
        CHECK(tiles.sums.points == 160000);
        CHECK(tiles.onDisk); // what the folder holds describes these cells, not the first ones
        auto points = pointsOf(tiles);
        CHECK(points.size() == 160000);
        if (!lie.readAgain) {
            CHECK(tiles.grid.cube == expected.grid.cube);
            CHECK((points == expectedPoints));
        }
        work->keep();
        work.reset();
        auto again = workFolder(folder / "work");
        Tiles resumed = tileOrFail(scan, options, *again);
        CHECK(resumed.rowsRead == 0);
        CHECK((pointsOf(resumed) == points));
    }
}

TEST_CASE("no checkpoint describes points that are being read again", "[tile]") {
    TemporaryFolder folder;
    auto paths = writeFiles(folder, 8);
    // The first seven headers state bounds far out, and hold points there; the last lies.
    for (std::size_t i = 0; i < 7; ++i) {
        TestScan far = surfaceScan(1, 20000, i);
        for (Vec3i& p : far.points.positions)
            p = p + Vec3i{2000000000, 2000000000, 2000000000};
        far.grid.offset = {20500000, 24000000, 20000000};
        writeScan(far, paths[i]);
    }
    TestScan last = surfaceScan(1, 20000, 7);
    last.grid.offset = {500000, 4000000, 0};
    writeScan(last, paths[7]);
    stateBounds(paths[7], {40500000, 44000000, 40000000}, {40500100, 44000100, 40000100});
    Scan scan = scanOrFail(paths);
    TileOptions options{.threads = 1, .memoryBytes = 1, .pointsPerRound = oneFile};
    auto work = workFolder(folder / "work");
    // Stopped when the second reading has just begun.
    std::atomic<bool> stop{false};
    options.stop = &stop;
    auto stopped = tile(scan, options, *work, [&](const std::string&, std::uint64_t done, std::uint64_t) {
        static std::uint64_t before = 0;
        if (done < before)
            stop = true;
        before = done;
    });
    REQUIRE_FALSE(stopped.ok());
    REQUIRE(stopped.error().code == ErrorCode::cancelled);
    CHECK_FALSE(work->load("tiles").ok());
    work->keep();
    work.reset();
    auto again = workFolder(folder / "work");
    options.stop = nullptr;
    Tiles tiles = tileOrFail(scan, options, *again);
    CHECK(tiles.sums.points == 160000);
    CHECK(pointsOf(tiles).size() == 160000);
}

TEST_CASE("a damaged checkpoint is started over", "[tile]") {
    TemporaryFolder folder;
    auto paths = writeFiles(folder, 4);
    Scan scan = scanOrFail(paths);
    TileOptions options{.threads = 1, .memoryBytes = 1, .pointsPerRound = oneFile};
    {
        auto work = workFolder(folder / "work");
        tileOrFail(scan, options, *work);
        work->keep();
    }
    {
        std::fstream file(folder / "work/tiles", std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(100);
        file.put('\x5A');
    }
    auto work = workFolder(folder / "work");
    Tiles tiles = tileOrFail(scan, options, *work);
    CHECK(tiles.rowsRead == 80000);
    CHECK(pointsOf(tiles).size() == 80000);
}

TEST_CASE("an input that changes or goes while it is read twice is refused", "[tile]") {
    TemporaryFolder folder;
    TestScan scan = surfaceScan(1, 300000, 1);
    for (bool vanishes : {false, true}) {
        writeScan(scan, folder / "a.las");
        stateBounds(folder / "a.las", {1, 1, 1}, {0, 0, 0}); // none: read for its bounds, then for its points
        Scan scanned = scanOrFail({folder / "a.las"});
        auto work = workFolder(folder / "work");
        auto change = [&](const std::string& phase, std::uint64_t done, std::uint64_t total) {
            if (phase == "measure" && done == total && vanishes)
                std::filesystem::remove(folder / "a.las");
            else if (phase == "measure" && done == total)
                writeScan(surfaceScan(1, 200000, 2), folder / "a.las");
        };
        auto tiles = tile(scanned, {.threads = 1}, *work, change);
        REQUIRE_FALSE(tiles.ok());
        CHECK(tiles.error().code == (vanishes ? ErrorCode::notFound : ErrorCode::changed));
        CHECK(tiles.error().where == folder / "a.las");
    }
}
