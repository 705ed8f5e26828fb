// Regions as JSON, for the page and for programs. World units; what is missing of a region is any height.
//
//   {"box": {"centre": [x, y, z], "halfSize": [x, y, z], "axes": [[…], […], […]]}}     as a clip box; axes:
//   may be absent
//   {"polygon": [[x, y], …], "heights": [low, high]}                                   heights: may be absent
//   {"line": [[x, y], …], "width": w, "heights": [low, high]}                          a profile's corridor
//   {"prism": {"eye": [x, y, z] or null, "forward": [x, y, z], "corners": [[x, y, z], …]}}
//                                                       a polygon on the screen
//                                                       (shared/geometry/screen_prism.hpp)
//
// {} is the whole cloud.
#pragma once

#include "shared/base/result.hpp"
#include "shared/select/point_filter.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace stipple {

// Errors: invalidArgument, naming the field.
Result<PointFilter> regionFromJson(const nlohmann::json& region, const std::string& path);
Result<ScreenPolygon> screenPolygonFromJson(const nlohmann::json& value, const std::string& path);
nlohmann::json toJson(const ScreenPolygon& polygon);

} // namespace stipple
