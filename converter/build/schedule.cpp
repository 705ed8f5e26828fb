#include "converter/build/schedule.hpp"

#include "converter/parallel/parallel.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <tuple>
#include <unordered_map>

namespace stipple {

namespace {
// Before which nodes a node goes.
auto rankOf(const NodeKey& key) {
    return std::make_tuple(key.indexInParent(), key.level, key);
}

class Schedule {
  public:
    Schedule(const std::vector<ScheduledNode>& nodes, const std::vector<std::vector<std::size_t>>& before,
             std::uint64_t memoryBytes, const std::atomic<bool>* stop,
             const std::function<Status(std::size_t)>& work)
        : nodes_(nodes), memoryBytes_(memoryBytes), stop_(stop), work_(work), waitsFor_(nodes.size(), 0),
          after_(nodes.size()) {
        ready_.reserve(nodes.size()); // nothing may be thrown where it grows
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (nodes[i].done)
                continue;
            ++left_;
            for (std::size_t earlier : before[i])
                if (!nodes[earlier].done) {
                    ++waitsFor_[i];
                    after_[earlier].push_back(i);
                }
            if (waitsFor_[i] == 0)
                ready_.push_back(i);
        }
    }

    Status run(int threads) {
        const std::size_t wanted = std::min(static_cast<std::size_t>(std::max(1, threads)), nodes_.size());
        std::vector<std::thread> pool =
            startThreads(wanted > 1 ? wanted - 1 : 0, [this](std::size_t) { loop(); });
        loop();
        for (std::thread& thread : pool)
            thread.join();
        if (error_)
            return *error_;
        if (outOfMemory_)
            return outOfMemory();
        return {};
    }

  private:
    void loop() {
        std::unique_lock lock(mutex_);
        while (left_ > 0 && !error_ && !outOfMemory_) {
            std::optional<std::size_t> next = take();
            if (!next) {
                changed_.wait(lock);
                continue;
            }
            --left_;
            ++running_;
            memoryInUse_ += nodes_[*next].memoryBytes;
            lock.unlock();
            attempt(*next);
            lock.lock();
            --running_;
            memoryInUse_ -= nodes_[*next].memoryBytes;
            for (std::size_t later : after_[*next])
                if (--waitsFor_[later] == 0)
                    ready_.push_back(later);
            changed_.notify_all();
        }
        changed_.notify_all();
    }

    // The largest ready node that the memory allows.
    std::optional<std::size_t> take() {
        auto best = ready_.end();
        for (auto at = ready_.begin(); at != ready_.end(); ++at) {
            bool fits = running_ == 0 || memoryInUse_ + nodes_[*at].memoryBytes <= memoryBytes_;
            if (fits && (best == ready_.end() || nodes_[*at].memoryBytes > nodes_[*best].memoryBytes))
                best = at;
        }
        if (best == ready_.end())
            return {};
        std::size_t index = *best;
        ready_.erase(best);
        return index;
    }

    // Notes what came of it; where memory has run out, without asking for any.
    void attempt(std::size_t index) {
        try {
            Status done = stop_ && *stop_ ? Error{ErrorCode::cancelled, "interrupted", "", ""} : work_(index);
            std::lock_guard lock(mutex_);
            if (!done && !error_)
                error_ = done.error();
        } catch (const std::bad_alloc&) {
            outOfMemory_ = true;
        }
    }

    const std::vector<ScheduledNode>& nodes_;
    const std::uint64_t memoryBytes_;
    const std::atomic<bool>* stop_;
    const std::function<Status(std::size_t)>& work_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<std::size_t> ready_, waitsFor_;
    std::vector<std::vector<std::size_t>> after_;
    std::size_t left_ = 0, running_ = 0; // not started; at work
    std::uint64_t memoryInUse_ = 0;
    std::optional<Error> error_;
    std::atomic<bool> outOfMemory_{false};
};
} // namespace

bool touches(const NodeKey& a, const NodeKey& b) {
    // In units of the deeper one's side: the boxes, one wider on each side, overlap.
    const int level = std::max(a.level, b.level);
    auto spanOf = [&](const NodeKey& key, std::uint32_t coordinate) {
        std::int64_t side = std::int64_t{1} << (level - key.level);
        return std::pair<std::int64_t, std::int64_t>(coordinate * side, coordinate * side + side);
    };
    auto meet = [&](std::uint32_t x, std::uint32_t y) {
        auto [aLow, aHigh] = spanOf(a, x);
        auto [bLow, bHigh] = spanOf(b, y);
        return aLow <= bHigh && bLow <= aHigh;
    };
    return meet(a.x, b.x) && meet(a.y, b.y) && meet(a.z, b.z);
}

std::vector<std::vector<std::size_t>> predecessors(const std::vector<ScheduledNode>& nodes) {
    std::unordered_map<NodeKey, std::size_t, NodeKeyHash> indexOf;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        indexOf.emplace(nodes[i].key, i);
    std::vector<std::vector<std::size_t>> before(nodes.size());
    auto relate = [&](std::size_t a, std::size_t b) {
        bool aFirst = rankOf(nodes[a].key) < rankOf(nodes[b].key);
        before[aFirst ? b : a].push_back(aFirst ? a : b);
    };
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const NodeKey& key = nodes[i].key;
        // Each neighbour of the same size or larger holds one of the 26 cubes around the node.
        for (int d = 0; d < 27; ++d) {
            NodeKey cube = key;
            cube.x += static_cast<std::uint32_t>(d % 3 - 1);     // below 0 they wrap round to keys that
            cube.y += static_cast<std::uint32_t>(d / 3 % 3 - 1); // do not exist
            cube.z += static_cast<std::uint32_t>(d / 9 - 1);
            std::uint64_t side = std::uint64_t{1} << key.level;
            if (cube == key || cube.x >= side || cube.y >= side || cube.z >= side)
                continue;
            for (;; cube = cube.parent()) {
                auto found = indexOf.find(cube);
                if (found != indexOf.end() && found->second != i)
                    relate(i, found->second);
                if (found != indexOf.end() || cube.level == 0)
                    break;
            }
        }
    }
    for (std::vector<std::size_t>& list : before) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return before;
}

Status runScheduled(const std::vector<ScheduledNode>& nodes,
                    const std::vector<std::vector<std::size_t>>& before, int threads,
                    std::uint64_t memoryBytes, const std::atomic<bool>* stop,
                    const std::function<Status(std::size_t index)>& work) {
    return Schedule(nodes, before, memoryBytes, stop, work).run(threads);
}

} // namespace stipple
