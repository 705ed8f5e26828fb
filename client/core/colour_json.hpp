// The colours, filters and clips of a style as JSON, part of client/core/json.hpp:
//
//   {"colourMode": "classification", "gradient": "viridis",
//    "intensityRange": [0, 4095], "elevationRange": null, "levelRange": null,
//    "attribute": "Amplitude", "attributeRange": null,
//    "mix": [{"colourMode": "rgb", "weight": 2}, {"colourMode": "intensity", "range": null, "weight": 1}],
//    "hiddenClasses": [7, 18],
//    "filters": [{"attribute": "Return Number", "min": 1, "max": 1}],
//    "clipBoxes": [{"mode": "hideOutside", "centre": [0, 0, 0], "halfSize": [1, 1, 1],
//                   "rotation": [0, 0, 0, 1]}],
//    "clipRegions": [{"mode": "highlight", "region": {…as in shared/select/region_json.hpp}}],
//    "highlight": [255, 64, 0]}
//
// A limit of a filter that is null or absent is none. A box is turned by a quaternion x, y, z, w of any
// length, or by "axes", its three unit vectors; neither: not at all. Lists are replaced as a whole.
#pragma once

#include "client/core/colour_style.hpp"
#include "shared/base/json_fields.hpp"

namespace stipple {

void readColours(json_fields::FieldReader& fields, ColourStyle& style);
nlohmann::json coloursJson(const ColourStyle& style);
// The field "colourMode" alone.
void readColourMode(json_fields::FieldReader& fields, ColourMode& mode);

// In the order of the enumeration: what `colourMode` may be.
std::vector<std::string> colourModeNames();

} // namespace stipple
