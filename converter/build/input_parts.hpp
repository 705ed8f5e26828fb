// Reading the inputs of a scan, part by part, as the cloud's points.
#pragma once

#include "converter/build/point_sums.hpp"
#include "converter/build/scan.hpp"

#include <functional>
#include <vector>

namespace stipple {

// One part of one input.
struct PartRef {
    std::size_t input = 0, part = 0;
    std::uint64_t points = 0; // that it will hand out, at most
};

// All parts of all inputs, in their order.
std::vector<PartRef> partsOf(const Scan& scan);

// What one thread reads with.
struct PartReader {
    PointBatch raw;    // as the input hands them out
    PointBatch mapped; // as the cloud's
    PointSums sums;    // of everything read so far but the hash
};

// Hands every batch of the part to `take`, on the cloud's grid and in its schema. Errors: the reader's and
// take's; `changed` if other points came than were counted when the input was opened.
Status readPart(const Scan& scan, const PartRef& ref, PartReader& reader,
                const std::function<Status(const PointBatch&)>& take);

} // namespace stipple
