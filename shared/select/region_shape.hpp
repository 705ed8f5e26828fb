// A region as people state it: plain numbers, world units, as they are kept, compared and written. What
// points are asked with (PointFilter, PointRegion) is made of them.
//
// Closed: sides, edges and ends belong to it. All parts that are given must hold; none of them: everywhere.
#pragma once

#include "shared/base/result.hpp"
#include "shared/geometry/oriented_box.hpp"
#include "shared/select/point_filter.hpp"

#include <optional>
#include <vector>

namespace stipple {

struct RegionShape {
    struct Box {
        Vec3d centre;
        Vec3d halfSize; // along its own axes, >= 0
        BoxAxes axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        friend bool operator==(const Box&, const Box&) = default;
    };
    std::optional<Box> box;
    // A polygon in plan: its outer ring, then its holes (shared/geometry/polygon.hpp). None: no polygon.
    std::vector<std::vector<Point2d>> rings;
    // A corridor in plan (shared/geometry/corridor.hpp). None: no corridor.
    std::vector<Point2d> line;
    double width = 0;
    std::optional<ScreenPolygon> prism;
    std::optional<ValueRange> heights; // infinite where open
    friend bool operator==(const RegionShape&, const RegionShape&) = default;

    bool isEverywhere() const { return *this == RegionShape(); }
    // Of polygon, line and prism.
    std::size_t cornerCount() const;
};

// Errors: invalidArgument for what can't be computed with; `where` is the part: box, polygon, line, prism or
// heights.
Result<PointFilter> filterOf(const RegionShape& shape);

} // namespace stipple
