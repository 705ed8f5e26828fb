// A gate that closes after so many points, and counts what it is asked and what is done between two
// questions.
#pragma once

#include "shared/base/work_gate.hpp"

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <limits>
#include <mutex>

namespace stipple::test {

class CountingGate final : public WorkGate {
  public:
    explicit CountingGate(std::uint64_t closesAfter = std::numeric_limits<std::uint64_t>::max())
        : closesAfter_(closesAfter) {}

    bool mayHandle(std::size_t items) const override {
        std::lock_guard lock(mutex_);
        largest_ = std::max(largest_, items);
        double now = cpuSeconds();
        longest_ = std::max(longest_, askedAt_ > 0 ? now - askedAt_ : 0);
        askedAt_ = now;
        if (handled_ >= closesAfter_) {
            ++refused_;
            return false;
        }
        handled_ += items;
        return true;
    }

    std::uint64_t handled() const {
        return handled_;
    }                                                // items let through, a point once for each loop over it
    std::size_t largest() const { return largest_; } // piece
    int refused() const { return refused_; }         // questions after it was closed
    // The most processor time between two questions; of work of one thread.
    double longestSeconds() const { return longest_; }

    static double cpuSeconds() {
        struct timespec time {};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }

  private:
    const std::uint64_t closesAfter_;
    mutable std::mutex mutex_;
    mutable std::uint64_t handled_ = 0;
    mutable std::size_t largest_ = 0;
    mutable int refused_ = 0;
    mutable double askedAt_ = 0, longest_ = 0;
};

} // namespace stipple::test
