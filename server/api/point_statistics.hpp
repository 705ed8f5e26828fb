// Statistics of chosen points of a cloud: of their coordinates and of the values that attributes mean.
// Exact but for the rounding of sums (converter/build/statistics.hpp), and the same for any threads.
#pragma once

#include "converter/build/statistics.hpp"
#include "shared/sinks/point_sink.hpp"

#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

namespace stipple::server {

// One coordinate or attribute: how its stored values become those that they mean, and how they are counted.
struct StatisticsColumn {
    Attribute attribute;       // of coordinates: int64 with the grid's scale and offset
    std::vector<double> edges; // ascending; interval i holds edges[i] <= value < edges[i + 1], the last one
                               // its end, too. Empty: values are not counted in intervals

    double meaningOf(double stored) const { return attribute.offset + attribute.scale * stored; }
};
// X, Y, Z, then the attributes of `input`. `bins` 0: no intervals. `reach` (grid integers) holds every point.
std::vector<StatisticsColumn> statisticsColumns(const SinkInput& input, const BoxI& reach, std::size_t bins);
// The interval of a value; nothing for one that lies in none.
std::optional<std::size_t> intervalOf(const std::vector<double>& edges, double value);

struct ColumnStatistics {
    PartialStatistics stored;          // of stored values, without those that mean "no value"
    std::vector<std::uint64_t> counts; // in intervals: edges.size() - 1
};

// Takes points and keeps nothing but their statistics.
class StatisticsSink final : public PointSink {
  public:
    explicit StatisticsSink(std::vector<StatisticsColumn> columns);
    Result<EncodedPoints> encode(PointBatch batch) const override;
    Status write(EncodedPoints points) override;
    Status finish() override { return {}; }

    const std::vector<StatisticsColumn>& columns() const { return columns_; }
    const std::vector<ColumnStatistics>& statistics() const { return all_; } // parallel to columns()

  private:
    using Part = std::vector<ColumnStatistics>;
    Part statisticsOf(const PointBatch& batch) const;

    std::vector<StatisticsColumn> columns_;
    Schema schema_; // of columns_
    Part all_;
    // Parts that are made by any thread and wait to be merged in order.
    mutable std::mutex mutex_;
    mutable std::unordered_map<std::uint64_t, Part> parts_;
    mutable std::uint64_t nextPart_ = 0;
};

} // namespace stipple::server
