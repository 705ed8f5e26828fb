// The region of a PointFilter, asked about places: what CloudFilter does with a whole cloud, for those who
// have a node's box and world positions. Decided from the same numbers, so a point that is exported is one
// that is clipped.
//
// Cheap to copy. Thread: not altered once made; any number of threads may ask.
#pragma once

#include "shared/select/point_filter.hpp"

namespace stipple {

class PointRegion {
  public:
    // Box, polygons, turned box, prism and corridor of it; what it says of grids and attributes counts for
    // nothing.
    explicit PointRegion(const PointFilter& filter);

    // `none` and `whole` are certain; `partial` may be said of a box that no side crosses.
    Overlap overlapOf(const BoxD& box) const;
    // What answers alike for all places in `box`, with no more tests than these need.
    PointRegion near(const BoxD& box) const;
    bool contains(Vec3d p) const;

  private:
    std::optional<BoxD> box_;
    std::shared_ptr<const PolygonRegion> polygons_;
    std::shared_ptr<const ConvexRegion> convex_;
    std::shared_ptr<const ScreenPrism> prism_;
    std::shared_ptr<const Corridor> corridor_;
    std::vector<std::uint32_t> corridorParts_; // those asked
    bool isNowhere_ = false;
};

} // namespace stipple
