#include "converter/synth/ordered_blocks.hpp"

#include <catch2/catch.hpp>

#include <atomic>

using namespace stipple::synth;

TEST_CASE("blocks arrive once each, in order, with few waiting, for any number of threads") {
    for (unsigned threads : {1u, 2u, 7u}) {
        std::atomic<std::uint64_t> made{0};
        std::uint64_t expected = 0, mostAhead = 0;
        runInOrder(
            500, threads,
            [&](std::uint64_t index) {
                ++made;
                return index * index;
            },
            [&](std::uint64_t index, std::uint64_t block) {
                CHECK(index == expected++);
                CHECK(block == index * index);
                mostAhead = std::max(mostAhead, made.load() - index);
                return true;
            });
        CHECK(expected == 500);
        CHECK(mostAhead <= 4 * threads + 1);
    }
}

TEST_CASE("a taker that stops ends the work early") {
    std::atomic<int> made{0};
    int taken = 0;
    runInOrder(
        1'000'000, 3, [&](std::uint64_t) { return ++made; }, [&](std::uint64_t, int) { return ++taken < 5; });
    CHECK(taken == 5);
    CHECK(made < 100);
}

TEST_CASE("no blocks, no calls") {
    bool called = false;
    runInOrder(
        0, 2, [](std::uint64_t) { return 0; },
        [&](std::uint64_t, int) {
            called = true;
            return true;
        });
    CHECK_FALSE(called);
}
