// Which of the things that wait travel together: neighbours in a file, up to a gap between them that costs
// less than a request of its own.
#pragma once

#include "client/core/load_item.hpp"
#include "client/core/load_limits.hpp"

#include <cstddef>
#include <functional>
#include <vector>

namespace stipple {

class LoadMerger {
  public:
    // Whether bytes of the range are here, or on their way: a gap with such is not read over.
    using IsHere = std::function<bool(std::uint32_t cloud, ByteRange range)>;
    // Items, which keep their places and ranges, and limits outlive this.
    LoadMerger(const std::vector<LoadItem>& items, const LoadLimits& limits, IsHere isHere);

    void take(std::size_t item) { taken_[item] = true; } // it is not to travel
    bool isTaken(std::size_t item) const { return taken_[item]; }

    struct Together {
        std::vector<std::size_t> items; // `first` first
        ByteRange range;
    };
    // Takes `first` and then its neighbours, alternately after and before, as far as limits allow.
    Together takeAround(std::size_t first, std::uint64_t mostGapBytes);

  private:
    bool tryAdd(Together& together, std::size_t item, std::uint64_t mostGapBytes);

    const std::vector<LoadItem>& items_;
    const LoadLimits& limits_;
    IsHere isHere_;
    std::vector<std::size_t> order_, place_; // of items by cloud and offset; where each is in it
    std::vector<bool> taken_;
    std::uint64_t usefulBytes_ = 0; // of the range that grows
};

ByteRange unionOf(ByteRange a, ByteRange b);

} // namespace stipple
