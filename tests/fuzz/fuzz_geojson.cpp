// GeoJSON, and questions to the region it makes.
#include "converter/export/geojson.hpp"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    std::string_view text(reinterpret_cast<const char*>(data), size);
    auto read = parseGeoJson(text, "fuzz");
    if (!read)
        return 0;
    const PolygonRegion& region = *read->region;
    for (const Polygon& polygon : region.polygons()) {
        const BoxD& bounds = polygon.outer.bounds();
        // The region's own corners, and boxes of a single point, which say what the point says.
        for (Point2d p : {Point2d{bounds.min.x, bounds.min.y}, {bounds.max.x, bounds.min.y}, {0, 0}}) {
            bool inside = region.contains(p);
            Overlap overlap = region.overlapOf({{p.x, p.y, 0}, {p.x, p.y, 0}});
            if ((overlap == Overlap::whole && !inside) || (overlap == Overlap::none && inside))
                std::abort();
        }
        if (region.overlapOf(bounds) == Overlap::none)
            std::abort();
    }
    return 0;
}
