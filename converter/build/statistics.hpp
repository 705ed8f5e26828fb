// Statistics of attributes, node by node. Sums of doubles depend on their order, so each node's are
// taken over its points in Morton order and merged in the order of the nodes: the same for any number of
// threads.
#pragma once

#include "shared/format/cloud_metadata.hpp"
#include "shared/points/point_batch.hpp"

#include <map>
#include <optional>
#include <vector>

namespace stipple {

// Of one attribute over some points. Values that are no number (NaN) are left out.
struct PartialStatistics {
    std::uint64_t count = 0;
    double min = 0, max = 0, mean = 0;
    double squares = 0; // Σ (value - mean)²
    // Value → points; nothing once there are more than 256 values, or the attribute is not of one integer.
    std::optional<std::map<std::int64_t, std::uint64_t>> histogram;

    // T. Chan, G. Golub, R. LeVeque 1979: the statistics of both sets of points.
    void merge(const PartialStatistics& other);
    AttributeStatistics finish() const;
};

using BatchStatistics = std::vector<PartialStatistics>; // parallel to the schema

BatchStatistics emptyStatistics(const Schema& schema);
BatchStatistics statisticsOf(const Schema& schema, const PointBatch& batch);
void merge(BatchStatistics& into, const BatchStatistics& other);

} // namespace stipple
