#include "converter/build/row_store.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

#include <algorithm>
#include <sys/stat.h>
#include <thread>

using namespace stipple;
using namespace stipple::test;

namespace {
constexpr std::size_t fewBuffers = 16; // what a pool has at least

std::unique_ptr<ScratchFile> scratchIn(TemporaryFolder& folder) {
    auto file = ScratchFile::create(folder / "rows");
    REQUIRE(file.ok());
    return std::move(file).value();
}

void appendOrFail(RowStore& store, std::size_t cell, const Bytes& rows, std::size_t rowBytes) {
    Status done = store.append(cell, rows.data(), rows.size() / rowBytes);
    if (!done)
        FAIL(done.error().sentence());
}

Bytes drained(RowStore& store, std::size_t cell, bool keep, std::size_t rowBytes) {
    Bytes all;
    Status done = store.drain(cell, keep, [&](const std::uint8_t* rows, std::size_t count) -> Status {
        all.insert(all.end(), rows, rows + count * rowBytes);
        return {};
    });
    if (!done)
        FAIL(done.error().sentence());
    return all;
}

// Cells of random rows, appended in random parts, and what each should hold.
std::vector<Bytes> fill(RowStore& store, std::size_t rowBytes, std::size_t rows, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<Bytes> expected(store.cells());
    for (std::size_t done = 0; done < rows;) {
        std::size_t cell = random() % store.cells(), count = std::min(rows - done, 1 + random() % 700);
        Bytes part(count * rowBytes);
        for (std::uint8_t& byte : part)
            byte = static_cast<std::uint8_t>(random());
        appendOrFail(store, cell, part, rowBytes);
        expected[cell].insert(expected[cell].end(), part.begin(), part.end());
        done += count;
    }
    return expected;
}

void checkHolds(RowStore& store, const std::vector<Bytes>& expected, bool keep, std::size_t rowBytes) {
    for (std::size_t cell = 0; cell < store.cells(); ++cell) {
        INFO("cell " << cell);
        CHECK(store.count(cell) == expected[cell].size() / rowBytes);
        CHECK((drained(store, cell, keep, rowBytes) == expected[cell]));
    }
}

std::uint64_t diskBytes(const std::string& path) {
    struct stat status {};
    REQUIRE(::stat(path.c_str(), &status) == 0);
    return static_cast<std::uint64_t>(status.st_blocks) * 512;
}
} // namespace

TEST_CASE("more rows than the buffers hold go to the file and come back in their order", "[rows]") {
    for (std::size_t rowBytes : {1u, 7u, 36u, 1000u, 65535u, 65536u}) {
        INFO(rowBytes << " bytes a row");
        TemporaryFolder folder;
        auto file = scratchIn(folder);
        RowPool pool(0, file.get());
        RowStore store(pool, rowBytes, 11);
        auto expected = fill(store, rowBytes, 3 * fewBuffers * RowPool::blockBytes / rowBytes, rowBytes);
        CHECK(pool.spilledBytes() > fewBuffers * RowPool::blockBytes);
        checkHolds(store, expected, true, rowBytes);
        checkHolds(store, expected, true, rowBytes);
        checkHolds(store, expected, false, rowBytes);
    }
}

TEST_CASE("more cells than buffers, none of them full, take turns", "[rows]") {
    TemporaryFolder folder;
    auto file = scratchIn(folder);
    RowPool pool(0, file.get());
    RowStore store(pool, 20, 10 * fewBuffers);
    auto expected = fill(store, 20, 100000, 5);
    CHECK(pool.spilledBytes() > 0);
    checkHolds(store, expected, false, 20);
}

TEST_CASE("rows that fit the memory allowed never touch the file", "[rows]") {
    TemporaryFolder folder;
    auto file = scratchIn(folder);
    RowPool pool(64 * RowPool::blockBytes, file.get());
    RowStore store(pool, 20, 4);
    auto expected = fill(store, 20, 100000, 5);
    CHECK(pool.spilledBytes() == 0);
    CHECK(file->end() == 0);
    checkHolds(store, expected, false, 20);
}

TEST_CASE("many threads append to the same cells and lose nothing", "[rows]") {
    constexpr std::size_t threads = 4, cells = 23, each = 60000, rowBytes = 24;
    TemporaryFolder folder;
    auto file = scratchIn(folder);
    RowPool pool(0, file.get());
    RowStore store(pool, rowBytes, cells);
    std::vector<std::thread> workers;
    std::atomic<bool> failed{false};
    auto appendSome = [&](std::size_t thread) {
        std::mt19937_64 random(thread);
        for (std::uint64_t at = 0; at < each;) {
            std::uint64_t count = std::min<std::uint64_t>(each - at, 1 + random() % 90);
            std::size_t cell = random() % cells;
            Bytes rows(count * rowBytes);
            for (std::uint64_t i = 0; i < count; ++i) {
                storeLe<std::uint64_t>(rows.data() + i * rowBytes, thread * each + at + i);
                storeLe<std::uint64_t>(rows.data() + i * rowBytes + 8, cell);
            }
            if (!store.append(cell, rows.data(), count))
                failed = true;
            at += count;
        }
    };
    for (std::size_t t = 0; t < threads; ++t)
        workers.emplace_back(appendSome, t);
    for (std::thread& worker : workers)
        worker.join();
    workers.clear();
    CHECK_FALSE(failed);
    CHECK(pool.spilledBytes() > 0);

    std::mutex mutex;
    std::vector<std::uint64_t> found;
    std::size_t misplaced = 0;
    auto drainSome = [&](std::size_t thread) {
        for (std::size_t cell = thread; cell < cells; cell += threads) {
            auto take = [&](const std::uint8_t* rows, std::size_t count) -> Status {
                std::lock_guard lock(mutex);
                for (std::size_t i = 0; i < count; ++i) {
                    found.push_back(loadLe<std::uint64_t>(rows + i * rowBytes));
                    misplaced += loadLe<std::uint64_t>(rows + i * rowBytes + 8) == cell ? 0 : 1;
                }
                return {};
            };
            if (!store.drain(cell, false, take))
                failed = true;
            store.forget(cell);
        }
    };
    for (std::size_t t = 0; t < threads; ++t)
        workers.emplace_back(drainSome, t);
    for (std::thread& worker : workers)
        worker.join();
    CHECK_FALSE(failed);
    CHECK(misplaced == 0);
    std::sort(found.begin(), found.end());
    REQUIRE(found.size() == threads * each);
    CHECK((found.front() == 0 && found.back() == threads * each - 1));
    CHECK(std::adjacent_find(found.begin(), found.end()) == found.end());
}

TEST_CASE("what was drained leaves memory, and its disk space is given back when it is forgotten", "[rows]") {
    constexpr std::size_t rowBytes = 32;
    TemporaryFolder folder;
    auto file = scratchIn(folder);
    RowPool pool(0, file.get());
    RowStore store(pool, rowBytes, 3);
    auto expected = fill(store, rowBytes, 200000, 9);
    REQUIRE(store.saveAll().ok());
    checkHolds(store, expected, false, rowBytes);
    checkHolds(store, expected, false, rowBytes); // now all of it from the file
    std::uint64_t before = diskBytes(file->path());
    for (std::size_t cell = 0; cell < store.cells(); ++cell) {
        store.forget(cell);
        CHECK(store.count(cell) == 0);
        CHECK(drained(store, cell, false, rowBytes).empty());
    }
    if (diskBytes(file->path()) == before)
        WARN("skipped: this file system can't give space back");
    else
        CHECK(diskBytes(file->path()) < before / 10);
    auto again = fill(store, rowBytes, 100000, 10); // forgotten cells can be filled again
    checkHolds(store, again, false, rowBytes);
}

TEST_CASE("a store is taken up from the file as it was described, and goes on", "[rows]") {
    constexpr std::size_t rowBytes = 28, cells = 9;
    TemporaryFolder folder;
    auto file = scratchIn(folder);
    Bytes description;
    std::vector<Bytes> expected;
    std::uint64_t end = 0;
    {
        RowPool pool(0, file.get());
        RowStore store(pool, rowBytes, cells);
        expected = fill(store, rowBytes, 100000, 21);
        REQUIRE(store.saveAll().ok());
        ByteWriter to;
        store.describe(to);
        description = to.take();
        end = file->end();
        fill(store, rowBytes, 50000, 22); // after the checkpoint: not part of it
    }
    file->setEnd(end);
    RowPool pool(0, file.get());
    RowStore store(pool, rowBytes, cells);
    ByteReader from(description);
    REQUIRE(store.restore(from));
    checkHolds(store, expected, true, rowBytes);
    auto more = fill(store, rowBytes, 100000, 23);
    for (std::size_t cell = 0; cell < cells; ++cell)
        expected[cell].insert(expected[cell].end(), more[cell].begin(), more[cell].end());
    checkHolds(store, expected, false, rowBytes);
}

TEST_CASE("a description that is cut, or of another store, is not taken up", "[rows]") {
    TemporaryFolder folder;
    auto file = scratchIn(folder);
    RowPool pool(0, file.get());
    RowStore store(pool, 28, 9);
    fill(store, 28, 50000, 1);
    REQUIRE(store.saveAll().ok());
    ByteWriter to;
    store.describe(to);
    auto restores = [&](ByteSpan bytes, std::size_t rowBytes, std::size_t cells) {
        RowPool otherPool(0, file.get());
        RowStore other(otherPool, rowBytes, cells);
        ByteReader from(bytes);
        return other.restore(from);
    };
    CHECK(restores(to.bytes(), 28, 9));
    CHECK_FALSE(restores(to.bytes(), 29, 9));
    CHECK_FALSE(restores(to.bytes(), 28, 8));
    for (std::size_t size = 0; size < to.size(); ++size)
        CHECK_FALSE(restores(ByteSpan(to.bytes()).first(size), 28, 9));
    Bytes outside = to.bytes();
    storeLe<std::uint64_t>(outside.data() + 20, file->end() + 1); // the first block's offset
    CHECK_FALSE(restores(outside, 28, 9));
}

TEST_CASE("without a file, points that do not fit the memory are refused", "[rows]") {
    RowPool pool(0, nullptr);
    RowStore store(pool, 16, 1);
    Bytes rows(RowPool::blockBytes);
    for (std::size_t i = 0; i < fewBuffers; ++i)
        REQUIRE(store.append(0, rows.data(), rows.size() / 16).ok());
    Status refused = store.append(0, rows.data(), 1);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().code == ErrorCode::limitExceeded);
    CHECK(refused.error().advice.find("--memory") != std::string::npos);
    CHECK_FALSE(store.saveAll().ok());
}

TEST_CASE("a full disk is reported by whoever needs a buffer", "[rows]") {
    TemporaryFolder folder;
    std::filesystem::create_symlink("/dev/full", folder / "rows");
    auto file = scratchIn(folder);
    RowPool pool(0, file.get());
    RowStore store(pool, 16, 2);
    Bytes rows(RowPool::blockBytes);
    Status done;
    for (std::size_t i = 0; i <= fewBuffers && done; ++i)
        done = store.append(i % 2, rows.data(), rows.size() / 16);
    REQUIRE_FALSE(done.ok());
    CHECK(done.error().code == ErrorCode::writeFailed);
    CHECK(done.error().sentence().find("No space left on device") != std::string::npos);
    CHECK(done.error().where == folder / "rows");
    CHECK_FALSE(store.saveAll().ok());
}

TEST_CASE("a small pool serves very many cells without looking at all of them", "[rows]") {
    // Every row begins a block: looking at each cell for each would take minutes.
    constexpr std::size_t cells = std::size_t{1} << 18, rowBytes = 12;
    TemporaryFolder folder;
    auto file = scratchIn(folder);
    RowPool pool(0, file.get());
    RowStore store(pool, rowBytes, cells);
    Bytes row(rowBytes);
    for (std::uint64_t i = 0; i < 20000; ++i) {
        storeLe<std::uint64_t>(row.data(), i);
        appendOrFail(store, i * 12345 % cells, row, rowBytes);
    }
    std::size_t wrong = 0;
    for (std::uint64_t i = 0; i < 20000; ++i) {
        storeLe<std::uint64_t>(row.data(), i);
        wrong += drained(store, i * 12345 % cells, false, rowBytes) == row ? 0 : 1;
    }
    CHECK(wrong == 0);
}
