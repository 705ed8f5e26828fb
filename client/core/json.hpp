// Camera, style, limits, counters and clouds as JSON: what `render --view` and `--style` take, what
// `render --json`, the page and golden scenes show. Field names are those of the structs; enumerations are
// their names; vectors are arrays; a Range is [min, max], or null for "from the cloud's statistics".
//
//   {"projection": "perspective", "position": [0, -10, 0], "target": [0, 0, 0], "up": [0, 0, 1],
//    "fovYDegrees": 60, "orthoHeight": 10}
//
// Reading: fields that are absent keep the value of `base`. A field of the wrong type or outside its range,
// and one that does not exist, is an invalidArgument error that names it.
#pragma once

#include "client/core/camera.hpp"
#include "client/core/counters.hpp"
#include "client/core/point_record.hpp"
#include "client/core/style.hpp"
#include "client/core/view_session.hpp"
#include "shared/base/result.hpp"

#include <nlohmann/json_fwd.hpp>

#include <concepts>
#include <optional>
#include <string>
#include <string_view>

namespace stipple {

// The value of a text. `what` names the text in messages: "--style".
Result<nlohmann::json> parseJson(std::string_view text, const std::string& what);
// One line; text that is not UTF-8 is shown with replacement characters.
std::string jsonText(const nlohmann::json& value);

// Each from a text or from a value.
Result<Camera> cameraFromJson(std::string_view text, const Camera& base = {});
Result<Style> styleFromJson(std::string_view text, const Style& base = {});
Result<SessionLimits> limitsFromJson(std::string_view text, const SessionLimits& base = {});
std::optional<NamedView> namedViewFromName(std::string_view name); // "top", "front", "side", "iso"

nlohmann::json toJson(const Camera& camera);
nlohmann::json toJson(const Style& style);
nlohmann::json toJson(const SessionLimits& limits);
nlohmann::json toJson(const FrameCounters& counters);
nlohmann::json toJson(const SessionCounters& counters);
nlohmann::json toJson(const Error& error);
nlohmann::json toJson(const BoxD& box); // {"min": […], "max": […]}, or null if empty
// Name, stage, visibility, what went wrong (the fields of CloudState under their own names; "missing": what
// was given up), and once ready: point count, world bounds, CRS, attribute names, classes (value, name,
// colour, number of points).
nlohmann::json toJson(const CloudState& cloud);
// {"integers": [x, y, z], "position": [x, y, z], "values": {"Intensity": 12, …}}: values as stored × scale +
// offset, whole numbers as such; several components as an array.
nlohmann::json toJson(const PointRecord& record);
nlohmann::json toJson(const PointIdentity& point); // {"cloud": 1, "node": "3-1-2-0", "index": 17}

// A JSON value converts to and from text by itself; these take nothing but a value.
namespace detail {
Result<Camera> readCamera(const nlohmann::json& value, const Camera& base);
Result<Style> readStyle(const nlohmann::json& value, const Style& base);
Result<SessionLimits> readLimits(const nlohmann::json& value, const SessionLimits& base);
} // namespace detail

template <std::same_as<nlohmann::json> Value>
Result<Camera> cameraFromJson(const Value& value, const Camera& base = {}) {
    return detail::readCamera(value, base);
}
template <std::same_as<nlohmann::json> Value>
Result<Style> styleFromJson(const Value& value, const Style& base = {}) {
    return detail::readStyle(value, base);
}
template <std::same_as<nlohmann::json> Value>
Result<SessionLimits> limitsFromJson(const Value& value, const SessionLimits& base = {}) {
    return detail::readLimits(value, base);
}

} // namespace stipple
