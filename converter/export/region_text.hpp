// A region as text, in any of the ways that programs have at hand:
//
//   {"type": "Polygon", "coordinates": …}         GeoJSON (geojson.hpp)
//   POLYGON ((30 10, 40 40, 20 40, 30 10), (…))   well-known text (OGC 06-103r4 §7.2), MULTIPOLYGON too; Z
//   and M are ignored 30,10;40,40;20,40                             the corners of one ring, closed or not
//
// Safe on untrusted text: memory is bounded by the text's length.
#pragma once

#include "converter/export/geojson.hpp"

#include <string>
#include <string_view>

namespace stipple {

// Errors, all invalidArgument: those of parseGeoJson(); for the others what is wrong and at which character,
// other geometries, EMPTY, rings that are not closed (well-known text) or have too few corners, numbers out
// of range.
Result<GeoJsonRegion> regionFromText(std::string_view text, const std::string& what);

} // namespace stipple
