// Cameras, styles, limits and counters as JSON: what `stipple render --view --style --json`, the page and
// golden scenes read and write. Keys are the fields' names in C++; enumerations are their enumerators' names;
// vectors and colours are arrays. Example:
//
//   camera  {"projection":"perspective","position":[0,-10,0],"target":[0,0,0],"up":[0,0,1],"fovYDegrees":60}
//   style   {"colourMode":"elevation","gradient":"turbo","sizePixels":3,"edl":{"enabled":false}}
//
// Reading changes the fields that are named and keeps the others. An unknown key, a wrong type or a value out
// of its range is `invalidArgument`, and nothing is changed then.
#pragma once

#include "client/core/camera.hpp"
#include "client/core/counters.hpp"
#include "client/core/style.hpp"
#include "client/core/view_session.hpp"
#include "shared/base/result.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace stipple {

Status updateCamera(Camera& camera, std::string_view json);
Status updateStyle(Style& style, std::string_view json);
Status updateLimits(SessionLimits& limits, std::string_view json);

std::string cameraJson(const Camera& camera);
std::string styleJson(const Style& style);
std::string limitsJson(const SessionLimits& limits);
std::string frameCountersJson(const FrameCounters& counters);
std::string sessionCountersJson(const SessionCounters& counters);

std::optional<NamedView> namedViewFromName(std::string_view name); // "top", "front", "iso"

} // namespace stipple
