// Regions as JSON, for the page and for programs. World units; what is missing of a region is any height.
//
//   {"box": {"centre": [x, y, z], "halfSize": [x, y, z], "axes": [[…], […], […]]}}     as a clip box; axes:
//   may be absent
//   {"polygon": [[x, y], …], "holes": [[[x, y], …], …], "heights": [low, high]}        holes and heights may
//   be
//                                                                                      absent, a height null
//   {"line": [[x, y], …], "width": w, "heights": [low, high]}                          a profile's corridor
//   {"prism": {"eye": [x, y, z] or null, "forward": [x, y, z], "corners": [[x, y, z], …]}}
//                                                       a polygon on the screen
//                                                       (shared/geometry/screen_prism.hpp)
//
// {} is the whole cloud. What is given together must hold together.
#pragma once

#include "shared/base/result.hpp"
#include "shared/select/region_shape.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

namespace stipple {

// Errors: invalidArgument, naming the field.
Result<RegionShape> shapeFromJson(const nlohmann::json& region, const std::string& path);
// The same, made a filter.
Result<PointFilter> regionFromJson(const nlohmann::json& region, const std::string& path);
// Adds the region of a JSON text to what a filter says already: both hold. Errors: the same, with the field's
// place ("prism.corners[2]") as `where`; text that is no JSON; a second turned box, polygon, line or prism;
// heights of which none are left.
Status addRegion(PointFilter& filter, std::string_view text);
// An error of filterOf(), with its part behind `path`.
Error inRegion(const std::string& path, const Error& error);
nlohmann::json toJson(const RegionShape& shape);
nlohmann::json toJson(const ScreenPolygon& polygon);

} // namespace stipple
