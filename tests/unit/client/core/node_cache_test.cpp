#include "client/core/node_cache.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

namespace {

// An entry of `bytes` bytes in all.
void put(NodeCache& cache, CacheKey key, std::size_t bytes) {
    cache.obtain(key).compressed.resize(bytes - sizeof(CachedNode));
    cache.recount(key);
}

} // namespace

TEST_CASE("the least recently used goes first, until the rest fits") {
    NodeCache cache;
    for (std::uint32_t node = 0; node < 4; ++node)
        put(cache, {1, node}, 1000);
    CHECK(cache.sizeBytes() == 4000);
    cache.touch({1, 0}, 7); // 1 is the oldest now
    CHECK(cache.evict(4000, 8).empty());
    CHECK(cache.evict(2500, 8) == std::vector<CacheKey>{{1, 1}, {1, 2}});
    CHECK(cache.sizeBytes() == 2000);
    CHECK(cache.peakBytes() == 4000);
    CHECK(cache.find({1, 1}) == nullptr);
    CHECK(cache.find({1, 0}) != nullptr);
}

TEST_CASE("what the present frame uses stays, whatever the limit") {
    NodeCache cache;
    for (std::uint32_t node = 0; node < 3; ++node)
        put(cache, {1, node}, 1000);
    cache.touch({1, 0}, 5);
    cache.touch({1, 1}, 5);
    CHECK(cache.evict(0, 5) == std::vector<CacheKey>{{1, 2}});
    CHECK(cache.size() == 2);
    CHECK(cache.evict(0, 6).size() == 2);
    CHECK(cache.sizeBytes() == 0);
}

TEST_CASE("an entry that changed is counted anew") {
    NodeCache cache;
    put(cache, {1, 1}, 5000);
    put(cache, {1, 1}, 700);
    CHECK(cache.sizeBytes() == 700);
    auto node = std::make_shared<ResidentNode>();
    node->positionWords.resize(200);
    cache.obtain({1, 1}).node = node;
    cache.recount({1, 1});
    CHECK(cache.sizeBytes() == 700 + sizeof(ResidentNode) + 800);
}

TEST_CASE("erasing a cloud leaves the others") {
    NodeCache cache;
    put(cache, {1, 5}, 1000);
    put(cache, {2, 0}, 1000);
    put(cache, {2, 9}, 1000);
    put(cache, {3, 1}, 1000);
    cache.eraseCloud(2);
    CHECK(cache.size() == 2);
    CHECK(cache.sizeBytes() == 2000);
    cache.erase({3, 1});
    cache.erase({3, 1});
    CHECK(cache.sizeBytes() == 1000);
    CHECK(cache.find({1, 5}) != nullptr);
}
