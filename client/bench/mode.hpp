// Ways of drawing that `stipple bench` compares: a style, limits of the session and a renderer each, in a
// table.
#pragma once

#include "client/core/style.hpp"
#include "client/core/view_session.hpp"
#include "client/headless/frame_drawer.hpp"
#include "shared/base/result.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace stipple::bench {

struct Mode {
    std::string name;
    std::string about; // one line for people
    Style style;
    SessionLimits limits; // its point budget is replaced by the bench's
    headless::Backend backend = headless::Backend::software;
    bool sweep = false; // run with every budget, not only the usual one
    // Sizes in world units, as a multiple of the mean distance of points seen from above, √(x side × y side /
    // points); 0: style.sizeWorld as it is.
    double worldSizeSpacings = 0;
    // Hides what lies outside a box in the middle of the cloud, this part of it long along each axis and
    // turned by 30 degrees about z; 0: no box.
    double clipPart = 0;
    // Modes of one group are a chart of the report: "skips". Empty: none.
    std::string group;
    // The mode that it is compared with in numbers, in the same group. Empty: none.
    std::string against;
};

// A new way to draw is a line in mode.cpp.
const std::vector<Mode>& builtInModes();

// [{"name": …, "about": …, "style": {…}, "limits": {…}, "backend": "software" or "gles", "sweep": true,
//   "worldSizeSpacings": 1, "clipPart": 0.5, "group": "skips", "against": "default", "without": ["unseen"]},
//   …]; all
// but the name may be absent. "without": what is not skipped (client/core/skips.hpp). Errors:
// invalidArgument, naming the field.
Result<std::vector<Mode>> modesFromJson(const nlohmann::json& json);
nlohmann::json toJson(const Mode& mode);
const char* backendName(headless::Backend backend);

} // namespace stipple::bench
