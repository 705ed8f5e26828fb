#include "client/core/node_cache.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

namespace {

// An entry of `bytes` bytes decoded (a multiple of four), with `compressed` more as they came.
void put(NodeCache& cache, CacheKey key, std::size_t bytes, std::size_t compressed = 0, int level = 0) {
    CachedNode& cached = cache.obtain(key, level);
    auto node = std::make_shared<ResidentNode>();
    node->positionWords.resize((bytes - sizeof(CachedNode) - sizeof(ResidentNode)) / 4);
    cached.node = node;
    cached.compressed.resize(compressed);
    cached.strataFetched = 2;
    cache.recount(key);
}

std::vector<CacheKey> evicted(NodeCache& cache, std::uint64_t limitBytes, std::uint64_t frame) {
    std::vector<CacheKey> keys;
    for (const NodeCache::Evicted& gone : cache.evict(limitBytes, frame))
        keys.push_back(gone.key);
    return keys;
}

} // namespace

TEST_CASE("the least recently used goes first, until the rest fits") {
    NodeCache cache;
    for (std::uint32_t node = 0; node < 4; ++node)
        put(cache, {1, node}, 1000);
    CHECK(cache.decodedBytes() == 4000);
    cache.touch({1, 0}, 7); // 1 is the oldest now
    CHECK(evicted(cache, 4000, 8).empty());
    CHECK(evicted(cache, 2500, 8) == std::vector<CacheKey>{{1, 1}, {1, 2}});
    CHECK(cache.decodedBytes() == 2000);
    CHECK(cache.decodedBytesPeak() == 4000);
    CHECK(cache.find({1, 1}) == nullptr);
    CHECK(cache.find({1, 0}) != nullptr);
}

TEST_CASE("what the present frame uses stays, whatever the limit") {
    NodeCache cache;
    for (std::uint32_t node = 0; node < 3; ++node)
        put(cache, {1, node}, 1000);
    cache.touch({1, 0}, 5);
    cache.touch({1, 1}, 5);
    CHECK(evicted(cache, 0, 5) == std::vector<CacheKey>{{1, 2}});
    CHECK(cache.size() == 2);
    CHECK(evicted(cache, 0, 6).size() == 2);
    CHECK(cache.decodedBytes() == 0);
}

TEST_CASE("what is coarse stays longer than what is fine, though it was used earlier") {
    NodeCache cache;
    put(cache, {1, 0}, 1000, 0, 2);
    put(cache, {1, 1}, 1000, 0, 3);
    put(cache, {1, 2}, 1000, 0, 5);
    cache.touch({1, 0}, 100);
    cache.touch({1, 1},
                100 + NodeCache::framesPerLevel + 1); // as recent as its level takes away, and one more
    cache.touch({1, 2}, 100 + 2 * NodeCache::framesPerLevel);
    CHECK(evicted(cache, 0, 1000) == std::vector<CacheKey>{{1, 2}, {1, 0}, {1, 1}});
}

TEST_CASE("bytes as they came have a limit of their own, and go with nodes that go") {
    NodeCache cache;
    for (std::uint32_t node = 0; node < 3; ++node)
        put(cache, {1, node}, 1000, 300);
    CHECK(cache.decodedBytes() == 3000);
    CHECK(cache.compressedBytes() == 900);
    std::vector<NodeCache::Evicted> gone = cache.evict(2000, 1);
    REQUIRE(gone.size() == 1);
    CHECK(gone[0].compressed.size() == 300);
    CHECK(cache.compressedBytes() == 600);
    cache.touch({1, 1}, 2);
    CHECK(cache.dropCompressed(600, 2) == 0);
    CHECK(cache.dropCompressed(599, 2) == 1);
    CHECK(cache.compressedBytes() == 300);
    CHECK(cache.decodedBytes() == 2000); // what was decoded stays, and is refined from the start
    CHECK(cache.find({1, 1})->strataFetched == 2);
    CHECK(cache.find({1, 2})->strataFetched == 0);
    CHECK(cache.dropCompressed(0, 2) == 0); // what the frame refines
    CHECK(cache.dropCompressed(0, 3) == 1);
}

TEST_CASE("an entry that changed is counted anew") {
    NodeCache cache;
    put(cache, {1, 1}, 5000, 40);
    put(cache, {1, 1}, 700, 8);
    CHECK(cache.decodedBytes() == 700);
    CHECK(cache.compressedBytes() == 8);
    auto node = std::make_shared<ResidentNode>();
    node->positionWords.resize(200);
    cache.obtain({1, 1}, 0).node = node;
    cache.recount({1, 1});
    CHECK(cache.decodedBytes() == sizeof(CachedNode) + sizeof(ResidentNode) + 800);
}

TEST_CASE("erasing a cloud leaves the others") {
    NodeCache cache;
    put(cache, {1, 5}, 1000, 10);
    put(cache, {2, 0}, 1000, 10);
    put(cache, {2, 9}, 1000, 10);
    put(cache, {3, 1}, 1000, 10);
    cache.eraseCloud(2);
    CHECK(cache.size() == 2);
    CHECK(cache.decodedBytes() == 2000);
    CHECK(cache.compressedBytes() == 20);
    cache.erase({3, 1});
    cache.erase({3, 1});
    CHECK(cache.decodedBytes() == 1000);
    CHECK(cache.find({1, 5}) != nullptr);
}
