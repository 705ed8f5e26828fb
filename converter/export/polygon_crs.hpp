// Whether polygons are in the coordinate system of a cloud.
#pragma once

#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"

#include <string>
#include <vector>

namespace stipple {

// `named`: what a GeoJSON "crs" member says, "EPSG:26910" or "urn:ogc:def:crs:EPSG::26910"; empty: nothing to
// check. Compared in plan, whatever the cloud's heights are in. invalidArgument with both names if it is
// another system; a warning where that can't be told.
Status checkPolygonCrs(const Crs& cloud, const std::string& named, std::vector<std::string>& warnings);

} // namespace stipple
