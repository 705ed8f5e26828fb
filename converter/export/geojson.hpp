// Regions out of GeoJSON (RFC 7946): Polygon, MultiPolygon, Feature, FeatureCollection and GeometryCollection
// of these; all their polygons together are the region. Coordinates are taken as they are, in the cloud's CRS
// (not as longitude and latitude); third numbers of positions are ignored.
//
// Safe on untrusted text: memory is bounded by the text's length, nesting by maxGeoJsonDepth.
#pragma once

#include "shared/base/result.hpp"
#include "shared/geometry/polygon.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace stipple {

inline constexpr int maxGeoJsonDepth = 32;                   // collections in collections
inline constexpr std::size_t maxGeoJsonBytes = 256ull << 20; // of a file

struct GeoJsonRegion {
    std::shared_ptr<const PolygonRegion> region;
    std::string crs; // what a "crs" member names (GeoJSON 2008 §3), "EPSG:26910"; empty: none
};

// Errors, all invalidArgument: text that is no JSON (with line and column), members that are missing or of
// the wrong kind, other geometries, rings of fewer than four positions or that are not closed, each with its
// place
// ("features[2].geometry.coordinates[0][5]"); no polygon at all. `what` names the text in messages.
Result<GeoJsonRegion> parseGeoJson(std::string_view text, const std::string& what);
Result<GeoJsonRegion> readGeoJson(const std::string& path);

} // namespace stipple
