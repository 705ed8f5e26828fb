// Whether two sets of points are the same multiset: every point of the one in the other exactly once, with
// every attribute equal. By comparing the points, not a hash of them.
#pragma once

#include "converter/build/point_store.hpp"
#include "shared/base/result.hpp"
#include "shared/geometry/grid.hpp"

#include <atomic>
#include <string>
#include <vector>

namespace stipple {

struct Comparison {
    std::uint64_t filePoints = 0, inputPoints = 0, equalPoints = 0;
    // Points without an equal. Those at one position are taken as pairs whose attributes differ …
    std::uint64_t changed = 0;
    std::vector<std::uint64_t> changedPerAttribute; // … and counted for each attribute that does
    std::uint64_t missing = 0;                      // the others: in the inputs, not in the file
    std::uint64_t surplus = 0;                      // in the file, not in the inputs
    std::vector<std::string> first; // the first differences in Morton order, one sentence each

    bool same() const { return changed == 0 && missing == 0 && surplus == 0; }
};

// Both stores hold points of `grid` and `schema`. Cost: 32 bytes a point of the larger, 4 of the smaller.
Result<Comparison> comparePoints(const PointStore& file, const PointStore& inputs, const Grid& grid,
                                 const Schema& schema, int threads, const std::atomic<bool>* stop);

} // namespace stipple
