// Lets long work on many points be broken off: its loops ask before each piece of it. A piece takes a
// millisecond or so, so work whose answer nobody wants any more ends at once, however large a node is.
#pragma once

#include "shared/base/result.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <type_traits>

namespace stipple {

class WorkGate {
  public:
    // What is handled between two questions, at most.
    static constexpr std::size_t pieceItems = 1 << 15;

    virtual ~WorkGate() = default;
    // May `items` more be handled in one go? Once no, always no. Thread: any.
    virtual bool mayHandle(std::size_t items) const = 0;
};

// Closed once a flag is set. The flag outlives it; null: never.
class StopGate final : public WorkGate {
  public:
    explicit StopGate(const std::atomic<bool>* stop) : stop_(stop) {}
    bool mayHandle(std::size_t) const override { return stop_ == nullptr || !*stop_; }

  private:
    const std::atomic<bool>* stop_;
};

inline Error brokenOff() {
    return {ErrorCode::cancelled, "interrupted", "", ""};
}

// Nothing, or `cancelled`. Null: never closed.
inline Status askGate(const WorkGate* gate, std::size_t items) {
    return gate == nullptr || gate->mayHandle(items) ? Status() : Status(brokenOff());
}

// Calls work(first, end) for 0 … count - 1 in ascending pieces; `work` returns nothing or a Status. Ends with
// the first failure, or with `cancelled` once the gate is closed.
template <class Work>
Status inPieces(const WorkGate* gate, std::size_t count, Work&& work) {
    for (std::size_t first = 0; first < count; first += WorkGate::pieceItems) {
        std::size_t end = first + std::min(WorkGate::pieceItems, count - first);
        STIPPLE_CHECK(askGate(gate, end - first));
        if constexpr (std::is_void_v<decltype(work(first, end))>)
            work(first, end);
        else
            STIPPLE_CHECK(work(first, end));
    }
    return {};
}

} // namespace stipple
