// The answer of /clouds/{id}/statistics:
//
//   {"id", "version",
//    "isComputed": false,           from what the file says of itself; true: from points that were read
//    "pointCount",
//    "bounds": {"min", "max"} or null,          of these points
//    "density": {"area", "pointsPerArea", "pointsPerSquareMeter"} or null,    over the bounds, in plan
//    "levels": [{"level", "spacing", "nodes", "points"}],
//    "coordinates": [{"name": "X", "min", "max", …}, Y, Z],
//    "attributes": [{"name", "type", "components", "unit", "count", "min", "max", "mean", "deviation",
//                    "values": [{"value", "points"}], "histogram": {"edges", "counts"}}],
//    "classes": [{"class", "name", "points"}],
//    "returns": {"numbers": [{"return", "points"}], "pulses": [{"returns", "points"}]}}
//
// Values are those that stored ones mean. Members that are not known are not there.
#pragma once

#include "server/api/point_statistics.hpp"

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace stipple::server {

struct LevelCount {
    std::uint64_t nodes = 0, points = 0;
};

struct StatisticsAnswer {
    std::string id, version;
    bool isComputed = false;
    std::uint64_t pointCount = 0;
    std::array<LevelCount, maxLevel + 1> levels{};
    std::vector<StatisticsColumn> columns; // X, Y, Z, then attributes
    std::vector<ColumnStatistics> statistics;
};

nlohmann::ordered_json statisticsJson(const StatisticsAnswer& answer, const CloudMetadata& metadata);

} // namespace stipple::server
