// Makes blocks 0, 1, 2 … in parallel and hands them over in order, with few waiting at a time.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace stipple::synth {

// `make(index)` runs on any of `threads` threads (the caller is one of them) and depends on nothing but the
// index; `take(index, block)` runs on the caller in the order of the indices and returns whether to go
// on. At most 4 × threads blocks wait. Neither may throw.
template <class Make, class Take>
void runInOrder(std::uint64_t count, unsigned threads, const Make& make, const Take& take) {
    using Block = decltype(make(std::uint64_t{0}));
    std::mutex mutex;
    std::condition_variable changed;
    std::map<std::uint64_t, Block> ready;
    std::uint64_t claimed = 0, taken = 0;
    bool stopped = false;
    const std::uint64_t window = 4 * static_cast<std::uint64_t>(threads);

    auto canClaim = [&] { return claimed < count && claimed < taken + window; };
    auto produceOne = [&](std::unique_lock<std::mutex>& lock) {
        std::uint64_t index = claimed++;
        lock.unlock();
        Block block = make(index);
        lock.lock();
        ready.emplace(index, std::move(block));
        changed.notify_all();
    };
    std::vector<std::thread> helpers;
    for (unsigned i = 1; i < threads; ++i)
        helpers.emplace_back([&] {
            std::unique_lock lock(mutex);
            while (!stopped && claimed < count) {
                if (canClaim())
                    produceOne(lock);
                else
                    changed.wait(lock);
            }
        });
    {
        std::unique_lock lock(mutex);
        while (!stopped && taken < count) {
            auto next = ready.find(taken);
            if (next != ready.end()) {
                Block block = std::move(next->second);
                ready.erase(next);
                lock.unlock();
                bool goOn = take(taken, std::move(block));
                lock.lock();
                ++taken;
                stopped = !goOn;
                changed.notify_all();
            } else if (canClaim()) {
                produceOne(lock);
            } else {
                changed.wait(lock);
            }
        }
        stopped = true;
        changed.notify_all();
    }
    for (std::thread& helper : helpers)
        helper.join();
}

} // namespace stipple::synth
