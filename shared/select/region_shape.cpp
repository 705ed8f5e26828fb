#include "shared/select/region_shape.hpp"

#include "shared/geometry/exact_sum.hpp"
#include "shared/select/region_options.hpp"

#include <algorithm>

namespace stipple {

namespace {

Error wrong(const char* part, Phrase what) {
    return {ErrorCode::invalidArgument, what, part, ""};
}

Result<std::shared_ptr<const PolygonRegion>> polygonOf(const std::vector<std::vector<Point2d>>& corners) {
    std::vector<Ring> rings;
    for (const std::vector<Point2d>& ring : corners) {
        if (ring.size() < 3)
            return wrong("polygon", say("each of its rings must have three corners at least"));
        for (Point2d corner : ring)
            if (!isExactlySummable(corner.x) || !isExactlySummable(corner.y))
                return wrong("polygon", say("a corner is out of range"));
        rings.emplace_back(ring);
    }
    Polygon polygon{std::move(rings.front()), {}};
    for (std::size_t hole = 1; hole < rings.size(); ++hole)
        polygon.holes.push_back(std::move(rings[hole]));
    return std::make_shared<const PolygonRegion>(std::vector<Polygon>{std::move(polygon)});
}

} // namespace

std::size_t RegionShape::cornerCount() const {
    std::size_t count = line.size() + (prism ? prism->corners.size() : 0);
    for (const std::vector<Point2d>& ring : rings)
        count += ring.size();
    return count;
}

Result<PointFilter> filterOf(const RegionShape& shape) {
    PointFilter filter;
    if (shape.box) {
        auto box = orientedBox(shape.box->centre, shape.box->halfSize * 2, shape.box->axes, false);
        if (!box)
            return box.error().at("box");
        filter.convex = std::make_shared<const ConvexRegion>(*std::move(box));
    }
    if (!shape.rings.empty()) {
        STIPPLE_TRY(polygon, polygonOf(shape.rings));
        filter.region = std::move(polygon);
    }
    if (!shape.line.empty()) {
        auto corridor = Corridor::make(shape.line, shape.width);
        if (!corridor)
            return corridor.error().at("line");
        filter.corridor = std::make_shared<const Corridor>(*std::move(corridor));
    }
    if (shape.prism) {
        auto prism = ScreenPrism::make(*shape.prism);
        if (!prism)
            return prism.error().at("prism");
        filter.prism = std::make_shared<const ScreenPrism>(*std::move(prism));
    }
    if (shape.heights) {
        if (!(shape.heights->min <= shape.heights->max))
            return wrong("heights", say("they must be [low, high] with low <= high"));
        limitHeights(filter, *shape.heights);
    }
    return filter;
}

} // namespace stipple
