// Measuring as JSON, for the page and for programs. A request names what is measured and the points, which
// are integers of a cloud's grid; the answer has what client/survey's functions say, in the cloud's unit and
// in degrees, each number that depends on where was picked with its standard deviation beside it ("±" of its
// name). A value that does not exist (the azimuth of an upright line) is null.
//
//   {"kind": "distance", "closed": false, "geocentric": false,
//    "points": [{"integers": [1, 2, 3], "scale": [0.01, 0.01, 0.01], "offset": [0, 0, 0], "spacing": 0.1},
//    …]}
//
//   kind      points   answer
//   point     1        position
//   distance  2 to n   distance, horizontal, vertical, ascent, descent, segments: [{distance, horizontal,
//                      vertical, azimuth, gradient}]
//   height    2 to n   height: from the lowest to the highest point; horizontal: between these two
//   azimuth   2        azimuth, gradient, distance, horizontal
//   angle     3        angle: at the second point
//   area      3 to n   horizontal, inPlane, perimeter, deviation, normal, crosses
//   circle    3        radius, diameter, circumference, area, centre, normal
//
// "geocentric": the coordinates are Earth-centred (WGS 84), so up and north depend on the place. "spacing":
// how far points are apart where this one was picked; absent or 0: the point is what was meant. Positions are
// world coordinates.
#pragma once

#include "shared/base/result.hpp"

#include <nlohmann/json_fwd.hpp>

namespace stipple::survey {

// Errors: invalidArgument, naming the field, or what can't be measured of such points.
Result<nlohmann::json> measureJson(const nlohmann::json& request);

} // namespace stipple::survey
