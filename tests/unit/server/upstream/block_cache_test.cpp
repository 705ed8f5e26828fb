#include "server/upstream/block_cache.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <mutex>
#include <thread>

using namespace stipple;
using namespace stipple::server;

namespace {

constexpr std::uint64_t size = BlockCache::blockBytes;
const std::atomic<bool> never{false};

// Bytes that say which block they are of; writes down what it is asked for.
struct Origin {
    std::mutex mutex;
    std::vector<ByteRange> asked;
    std::chrono::milliseconds takes{0};

    BlockCache::Fetch fetch() {
        return [this](ByteRange range) -> Result<Bytes> {
            {
                std::lock_guard lock(mutex);
                asked.push_back(range);
            }
            std::this_thread::sleep_for(takes);
            Bytes bytes(static_cast<std::size_t>(range.size));
            for (std::size_t i = 0; i < bytes.size(); ++i)
                bytes[i] = static_cast<std::uint8_t>((range.offset + i) / size + 1);
            return bytes;
        };
    }
};

} // namespace

TEST_CASE("the blocks of a range are those that hold one of its bytes") {
    CHECK(BlockCache::blocksOf({0, 0}).count == 0);
    CHECK(BlockCache::blocksOf({size - 1, 1}).first == 0);
    CHECK(BlockCache::blocksOf({size - 1, 1}).count == 1);
    CHECK(BlockCache::blocksOf({size - 1, 2}).count == 2);
    CHECK(BlockCache::blocksOf({size, size}).first == 1);
    CHECK(BlockCache::blocksOf({size, size}).count == 1);
}

TEST_CASE("neighbours that are missing come in one request, what is held is not asked for again") {
    BlockCache cache(16 * size);
    Origin origin;
    BlockCache::File file{1, 5 * size + 7};
    REQUIRE(cache.get(file, {2, 1}, origin.fetch(), never).ok());
    auto blocks = cache.get(file, {0, 6}, origin.fetch(), never);
    REQUIRE(blocks.ok());
    REQUIRE(origin.asked.size() == 3);
    CHECK(origin.asked[1] == ByteRange{0, 2 * size});
    CHECK(origin.asked[2] == ByteRange{3 * size, 2 * size + 7});
    for (std::size_t i = 0; i < 6; ++i) {
        CHECK((*blocks)[i]->size() == (i < 5 ? size : 7));
        CHECK((*blocks)[i]->front() == i + 1);
        CHECK((*blocks)[i]->back() == i + 1);
    }
    CHECK(cache.get(file, {0, 6}, origin.fetch(), never).ok());
    CHECK(origin.asked.size() == 3);
    CHECK_FALSE(cache.find({2, 5 * size + 7}, 0)); // of another version
}

TEST_CASE("what is held never exceeds the limit, and the least recently used leave first") {
    BlockCache cache(3 * size);
    Origin origin;
    BlockCache::File file{1, 10 * size};
    REQUIRE(cache.get(file, {0, 10}, origin.fetch(), never).ok());
    CHECK(cache.counts().bytes == 3 * size);
    CHECK(cache.counts().evicted == 7);
    CHECK(cache.find(file, 7));
    REQUIRE(cache.get(file, {0, 1}, origin.fetch(), never).ok());
    CHECK(cache.find(file, 7));
    CHECK_FALSE(cache.find(file, 8));
}

TEST_CASE("many that want the same blocks at once make one request for each") {
    BlockCache cache(64 * size);
    Origin origin;
    origin.takes = std::chrono::milliseconds(100);
    BlockCache::File file{1, 8 * size};
    std::vector<std::thread> threads;
    std::atomic<int> right{0};
    for (std::uint64_t i = 0; i < 12; ++i)
        threads.emplace_back([&, i] {
            auto blocks = cache.get(file, {i % 4, 4}, origin.fetch(), never);
            right += blocks.ok() && (*blocks)[3]->front() == i % 4 + 4;
        });
    for (std::thread& thread : threads)
        thread.join();
    CHECK(right == 12);
    std::uint64_t bytes = 0;
    for (const ByteRange& range : origin.asked)
        bytes += range.size;
    CHECK(bytes == 7 * size); // blocks 0 to 6, each once
    CHECK(cache.counts().waits > 0);
}

TEST_CASE("a failure reaches all that wait, is not kept, and one that gives up is replaced by another") {
    BlockCache cache(64 * size);
    BlockCache::File file{1, size};
    std::atomic<int> calls{0};
    std::atomic<bool> isFetching{false};
    auto failing = [&](ErrorCode code) {
        return [&, code](ByteRange) -> Result<Bytes> {
            ++calls;
            isFetching = true;
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
            return Error{code, "down", "", ""};
        };
    };
    Origin origin;
    for (ErrorCode code : {ErrorCode::networkFailed, ErrorCode::cancelled}) {
        isFetching = false;
        std::thread first([&] { CHECK(cache.get(file, {0, 1}, failing(code), never).error().code == code); });
        while (!isFetching)
            std::this_thread::yield();
        auto second = cache.get(file, {0, 1}, origin.fetch(), never);
        first.join();
        if (code == ErrorCode::networkFailed)
            CHECK(second.error().code == ErrorCode::networkFailed);
        else
            CHECK(second.ok());
    }
    CHECK(calls == 2);
    CHECK(origin.asked.size() == 1);
}

TEST_CASE("whoever is stopped does not wait on, and short answers are errors") {
    BlockCache cache(64 * size);
    BlockCache::File file{1, size};
    std::atomic<bool> stop{true};
    Origin origin;
    CHECK(cache.get(file, {0, 1}, origin.fetch(), stop).error().code == ErrorCode::cancelled);
    CHECK(origin.asked.empty());
    auto shortOne = [](ByteRange range) -> Result<Bytes> {
        return Bytes(static_cast<std::size_t>(range.size - 1));
    };
    CHECK(cache.get(file, {0, 1}, shortOne, never).error().code == ErrorCode::truncated);
    CHECK(cache.counts().bytes == 0);
}
