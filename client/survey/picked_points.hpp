// The points of a request that were picked in clouds, as JSON has them (measure_json.hpp).
#pragma once

#include "client/survey/exact_points.hpp"
#include "shared/base/result.hpp"

#include <nlohmann/json_fwd.hpp>

#include <vector>

namespace stipple::survey {

inline constexpr std::size_t maxPickedPoints = 10000;

struct PickedPoints {
    std::vector<GridPoint> points;  // one at least
    std::vector<double> deviations; // of each, from its spacing; 0 where it has none
};

// Of the field "points". Errors: invalidArgument, naming the field.
Result<PickedPoints> pickedPointsFrom(const nlohmann::json& request);

} // namespace stipple::survey
