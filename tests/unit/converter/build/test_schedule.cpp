#include "converter/build/schedule.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <new>
#include <numeric>
#include <random>
#include <set>
#include <thread>
#include <tuple>

using namespace stipple;

namespace {
// Nodes that part the cube or some of it: each is split, kept or left out at random.
void cut(const NodeKey& key, int deepest, std::mt19937& random, std::vector<ScheduledNode>& nodes) {
    unsigned dice = random() % 8;
    if (key.level < deepest && (key.level == 0 || dice < 4)) {
        for (int child = 0; child < 8; ++child)
            cut(key.child(child), deepest, random, nodes);
    } else if (dice < 7) {
        nodes.push_back({key, 1 + random() % 100, false});
    }
}

std::vector<ScheduledNode> randomCut(unsigned seed, int deepest = 4) {
    std::mt19937 random(seed);
    std::vector<ScheduledNode> nodes;
    cut({}, deepest, random, nodes);
    std::shuffle(nodes.begin(), nodes.end(), random);
    return nodes;
}

// The node's cube, counted in cubes of level 8: closed intervals.
struct Cube {
    std::int64_t low[3], high[3];
};
Cube cubeOf(const NodeKey& key) {
    std::int64_t side = std::int64_t{1} << (8 - key.level);
    return {{key.x * side, key.y * side, key.z * side},
            {(key.x + 1) * side, (key.y + 1) * side, (key.z + 1) * side}};
}
bool meet(const NodeKey& a, const NodeKey& b) {
    Cube p = cubeOf(a), q = cubeOf(b);
    for (int axis = 0; axis < 3; ++axis)
        if (p.high[axis] < q.low[axis] || q.high[axis] < p.low[axis])
            return false;
    return true;
}

bool goesFirst(const NodeKey& a, const NodeKey& b) {
    return std::make_tuple(a.indexInParent(), a.level, a) < std::make_tuple(b.indexInParent(), b.level, b);
}

// What a run did, and whether it broke a rule on the way.
struct Record {
    std::mutex mutex;
    std::vector<int> calls, finished;
    std::uint64_t memory = 0;
    std::size_t running = 0, mostRunning = 0, tooEarly = 0, tooMuch = 0;
};

Status runRecorded(const std::vector<ScheduledNode>& nodes, int threads, std::uint64_t memoryBytes,
                   Record& record) {
    auto before = predecessors(nodes);
    record.calls.assign(nodes.size(), 0);
    record.finished.assign(nodes.size(), 0);
    return runScheduled(nodes, before, threads, memoryBytes, nullptr, [&](std::size_t i) -> Status {
        {
            std::lock_guard lock(record.mutex);
            ++record.calls[i];
            for (std::size_t earlier : before[i])
                record.tooEarly += nodes[earlier].done || record.finished[earlier] ? 0 : 1;
            record.memory += nodes[i].memoryBytes;
            ++record.running;
            record.mostRunning = std::max(record.mostRunning, record.running);
            record.tooMuch += record.running > 1 && record.memory > memoryBytes ? 1 : 0;
        }
        std::this_thread::sleep_for(std::chrono::microseconds(20));
        std::lock_guard lock(record.mutex);
        record.memory -= nodes[i].memoryBytes;
        --record.running;
        record.finished[i] = 1;
        return {};
    });
}
} // namespace

TEST_CASE("nodes touch where their cubes share a face, an edge or a corner", "[schedule]") {
    auto nodes = randomCut(1);
    std::size_t wrong = 0, touching = 0;
    for (const ScheduledNode& a : nodes)
        for (const ScheduledNode& b : nodes)
            if (a.key != b.key) {
                wrong += touches(a.key, b.key) == meet(a.key, b.key) ? 0 : 1;
                touching += touches(a.key, b.key) ? 1 : 0;
            }
    CHECK(wrong == 0);
    CHECK(touching > nodes.size());
    // At the deepest level, where a neighbour's coordinate is the largest there is.
    constexpr std::uint32_t last = (1u << maxLevel) - 1;
    CHECK(touches({maxLevel, last, 0, 5}, {maxLevel, last - 1, 1, 4}));
    CHECK_FALSE(touches({maxLevel, last, 0, 5}, {maxLevel, 0, 0, 5}));
}

TEST_CASE("a node's predecessors are those that touch it and rank before it", "[schedule]") {
    for (unsigned seed = 0; seed < 20; ++seed) {
        INFO("seed " << seed);
        auto nodes = randomCut(seed, seed % 2 == 0 ? 3 : 4);
        auto before = predecessors(nodes);
        REQUIRE(before.size() == nodes.size());
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            std::vector<std::size_t> expected;
            for (std::size_t j = 0; j < nodes.size(); ++j)
                if (j != i && meet(nodes[i].key, nodes[j].key) && goesFirst(nodes[j].key, nodes[i].key))
                    expected.push_back(j);
            wrong += before[i] == expected ? 0 : 1;
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("each node runs once, after its predecessors and within the memory", "[schedule]") {
    for (int threads = 1; threads <= 4; ++threads)
        for (std::uint64_t memory : {0u, 120u, 1000000u}) {
            INFO(threads << " threads, memory " << memory);
            auto nodes = randomCut(7, 3);
            Record record;
            REQUIRE(runRecorded(nodes, threads, memory, record).ok());
            CHECK(std::count(record.calls.begin(), record.calls.end(), 1) ==
                  static_cast<std::ptrdiff_t>(nodes.size()));
            CHECK(record.tooEarly == 0);
            CHECK(record.tooMuch == 0);
            CHECK(record.mostRunning <= static_cast<std::size_t>(threads));
            CHECK((memory > 0 || record.mostRunning == 1));
        }
}

TEST_CASE("what is done already does not run again and holds nobody up", "[schedule]") {
    auto nodes = randomCut(11, 3);
    std::mt19937 random(3);
    for (ScheduledNode& node : nodes)
        node.done = random() % 2 == 0;
    Record record;
    REQUIRE(runRecorded(nodes, 3, 300, record).ok());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        wrong += record.calls[i] == (nodes[i].done ? 0 : 1) ? 0 : 1;
    CHECK(wrong == 0);
    CHECK(record.tooEarly == 0);
    for (ScheduledNode& node : nodes)
        node.done = true;
    Record idle;
    CHECK(runRecorded(nodes, 3, 300, idle).ok());
    CHECK(runRecorded({}, 3, 300, idle).ok());
}

TEST_CASE("after an error nothing more starts, and it is the one returned", "[schedule]") {
    auto nodes = randomCut(5, 3);
    auto before = predecessors(nodes);
    for (int threads = 1; threads <= 4; ++threads) {
        std::atomic<int> calls{0};
        Status done = runScheduled(nodes, before, threads, 1000000, nullptr, [&](std::size_t) -> Status {
            if (++calls == 9)
                return Error{ErrorCode::corrupt, "the ninth", "", ""};
            return {};
        });
        REQUIRE_FALSE(done.ok());
        CHECK(done.error().what == "the ninth");
        // Those that ran beside it may have been followed by one each before it was heard of.
        CHECK(calls >= 9);
        CHECK((threads > 1 || calls == 9));
    }
}

TEST_CASE("a stopped run is cancelled, one without memory says so", "[schedule]") {
    auto nodes = randomCut(5, 3);
    auto before = predecessors(nodes);
    for (int threads = 1; threads <= 4; ++threads) {
        std::atomic<bool> stop{false};
        std::atomic<int> calls{0};
        Status done = runScheduled(nodes, before, threads, 1000000, &stop, [&](std::size_t) -> Status {
            if (++calls == 5)
                stop = true;
            return {};
        });
        REQUIRE_FALSE(done.ok());
        CHECK(done.error().code == ErrorCode::cancelled);
        CHECK(calls < static_cast<int>(nodes.size()));
        Status full = runScheduled(nodes, before, threads, 1000000, nullptr,
                                   [&](std::size_t) -> Status { throw std::bad_alloc(); });
        REQUIRE_FALSE(full.ok());
        CHECK(full.error().code == ErrorCode::outOfMemory);
        CHECK(full.error().advice.find("--memory") != std::string::npos);
    }
}
