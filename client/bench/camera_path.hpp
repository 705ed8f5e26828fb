// The ways along which a cloud is looked at by `stipple bench`: lists of cameras. The same bounds give the
// same cameras.
#pragma once

#include "client/core/camera.hpp"
#include "shared/base/result.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace stipple::bench {

struct CameraPath {
    std::string name;
    std::vector<Camera> cameras; // at least one
};

// Names of the built-in paths:
//   fly-over  above the content along its longer side, looking ahead and down
//   walk      inside it, looking ahead
//   orbit     once around it
//   jump      from place to place, near and far, with nothing in between
//   dolly     slowly towards its middle: 3 % nearer each frame
//   map       orthographic from above, each frame at seven tenths of the height of the one before
std::vector<std::string_view> pathNames();

// `content` must not be empty (a single point will do); `frames` >= 1. Error: invalidArgument for an unknown
// name.
Result<CameraPath> builtInPath(std::string_view name, const BoxD& content, int frames);

// {"paths": [{"name": "site", "cameras": [{…}, …]}, …]}: cameras as client/core/json.hpp reads them, what is
// absent taken from the one before. Errors: invalidArgument, naming the field.
Result<std::vector<CameraPath>> pathsFromJson(const nlohmann::json& json);
nlohmann::json toJson(const CameraPath& path);

} // namespace stipple::bench
