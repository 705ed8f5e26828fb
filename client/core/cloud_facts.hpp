// What a file says of its cloud that controls, legends and maps are made of, as JSON: asked for once a cloud,
// where CloudState (json.hpp) is read many times a second.
//
//   {"crs": {"name": "WGS 84 / UTM zone 10N", "epsg": 32610, "wkt": "…", "proj": "+proj=utm +zone=10 …",
//            "unit": "metre", "unitMeters": 1, "vertical": "", "geocentric": false},
//    "attributes": [{"name": "Intensity", "type": "uint16", "components": 1, "unit": "", "description": "",
//                    "isWhole": true, "min": 0, "max": 4095, "mean": 310.2, "deviation": 120.8}, …]}
//
// `epsg` is null where it is not known. Statistics are of what values mean (offset + scale × stored), over
// the whole cloud, and null where a cloud has none.
#pragma once

#include "shared/format/cloud_metadata.hpp"

#include <nlohmann/json_fwd.hpp>

namespace stipple {

nlohmann::json cloudFactsJson(const CloudMetadata& metadata);

// Coordinates from the middle of the earth, where up and north are those of the place.
bool isGeocentric(const Crs& crs);

} // namespace stipple
