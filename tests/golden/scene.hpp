// A golden scene: what scene.json says.
//
//   {"about": "one line for people",
//    "cloud": {"kind": "waves", "points": 40000, "side": 80, "origin": [637000, 4849000, 130], "scale":
//    0.01}, "view": "iso" or a camera {…}, "projection": "perspective", "style": {…}, "size": [160, 120],
//    "budget": 20000}
//
// Clouds: "waves" is a rolling ground with a wall of pillars, in plain arithmetic (no library functions that
// differ between machines); "synth" is a scan by converter/synth: {"kind": "synth", "scene": "town",
// "points": 50000, "seed": 1, "normals": true}. "colours": "exact" or "mean" is `convert --colours`.
#pragma once

#include "client/headless/picture.hpp"
#include "shared/base/result.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace stipple::golden {

struct Scene {
    std::string name, folder;
    nlohmann::json cloud;
    headless::PictureRequest request;
};

// Errors name the file and the field.
Result<Scene> readScene(const std::string& folder);

// Makes the cloud of a scene as a .stipple file in `workFolder`, unless this run has made it already;
// returns its path.
Result<std::string> makeCloud(const nlohmann::json& cloud, const std::string& workFolder);

} // namespace stipple::golden
