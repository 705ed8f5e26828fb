// A set of bytes of a file, as ranges.
#pragma once

#include "shared/io/byte_source.hpp"

#include <algorithm>
#include <cstdint>
#include <map>

namespace stipple {

class ByteRanges {
  public:
    // Adds a range; the answer is how many of its bytes were there already.
    std::uint64_t add(ByteRange range) {
        if (range.size == 0)
            return 0;
        std::uint64_t begin = range.offset, end = range.end(), common = 0;
        auto at = ends_.upper_bound(begin);
        if (at != ends_.begin() && std::prev(at)->second >= begin)
            --at;
        while (at != ends_.end() && at->first <= end) {
            std::uint64_t from = std::max(at->first, range.offset), to = std::min(at->second, range.end());
            common += to > from ? to - from : 0;
            begin = std::min(begin, at->first);
            end = std::max(end, at->second);
            at = ends_.erase(at);
        }
        ends_[begin] = end;
        return common;
    }

    bool overlaps(ByteRange range) const {
        auto next = ends_.lower_bound(range.end());
        return range.size > 0 && next != ends_.begin() && std::prev(next)->second > range.offset;
    }

  private:
    std::map<std::uint64_t, std::uint64_t> ends_; // by begin; neither overlapping nor touching
};

} // namespace stipple
