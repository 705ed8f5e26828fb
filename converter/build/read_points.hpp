// All points of the inputs into memory, on the cloud's grid and in its schema; what is summed on the way.
#pragma once

#include "converter/build/convert.hpp"
#include "converter/build/point_store.hpp"
#include "converter/build/point_sums.hpp"

namespace stipple {

struct LoadedPoints {
    PointStore store;
    PointSums sums;
};

// Reads each input once. Errors: those of the readers; limitExceeded if memory does not suffice.
Result<LoadedPoints> readPoints(const Scan& scan, int threads, const std::atomic<bool>* stop,
                                const ConvertProgress& progress);

} // namespace stipple
