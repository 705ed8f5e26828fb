#include "shared/las/point_summary.hpp"

namespace stipple::las {

void addToSummary(PointSummary& summary, const SummaryColumns& columns, const Schema& schema,
                  const PointBatch& batch) {
    summary.ranges.resize(columns.described.size());
    summary.pointCount += batch.size();
    for (Vec3i p : batch.positions)
        summary.bounds.extend(p);
    if (columns.returnNumber >= 0) {
        std::array<std::uint64_t, 256> counts{};
        for (std::uint8_t number : batch.columns[static_cast<std::size_t>(columns.returnNumber)])
            ++counts[number];
        std::size_t returns = columns.pointFormat >= 6 ? 15 : 5;
        for (std::size_t i = 0; i < returns; ++i)
            summary.pointsByReturn[i] += counts[i + 1];
    }
    for (std::size_t i = 0; i < columns.described.size(); ++i) {
        std::size_t a = columns.described[i];
        extendRange(summary.ranges[i], schema.attributes[a], batch.columns[a]);
    }
}

} // namespace stipple::las
