// What a LAS file says about its points before they come: how many, by return, where, and the ranges of its
// extra bytes.
#pragma once

#include "shared/geometry/box.hpp"
#include "shared/las/extra_bytes.hpp"
#include "shared/points/point_batch.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace stipple::las {

// The same however points are cut into batches.
struct PointSummary {
    std::uint64_t pointCount = 0;
    std::array<std::uint64_t, 15> pointsByReturn{}; // of returns 1, 2, …
    BoxI bounds;                                    // grid integers
    std::vector<ValueRange> ranges;                 // of the described extra bytes, in their order

    friend bool operator==(const PointSummary&, const PointSummary&) = default;
};

// Which of a batch's columns count for a summary.
struct SummaryColumns {
    int pointFormat = 0;                // formats below 6 count five returns
    int returnNumber = -1;              // -1: there is none, and no counts by return
    std::vector<std::size_t> described; // extra bytes that get a descriptor
};

// `batch` has the columns of `schema`. summary.ranges has a place for each described column, or is empty
// before the first batch.
void addToSummary(PointSummary& summary, const SummaryColumns& columns, const Schema& schema,
                  const PointBatch& batch);

} // namespace stipple::las
